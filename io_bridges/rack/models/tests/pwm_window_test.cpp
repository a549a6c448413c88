// Pulses of a bridge by hand: their charge over a PWM period is known in closed form.
#include "io_bridges/rack/models/pwm_window.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/near.hpp"

namespace whirl::rack {
namespace {

constexpr Nanoseconds kPeriod = 50'000;

struct Pulses {
  // Current for so long, in steps as long as the power stage takes.
  void carry(double current_A, Nanoseconds length_ns) {
    while (length_ns > 0) {
      const Nanoseconds step = std::min<Nanoseconds>(length_ns, 25'000);
      now += step, length_ns -= step;
      window.flow(current_A * static_cast<double>(step) * 1e-9, now);
    }
  }
  // `on_ns` of each period at 20 A.
  void pulse(Nanoseconds on_ns, Nanoseconds period_ns = kPeriod) {
    window.upper_switch_on();
    carry(20.0, on_ns);
    carry(0.0, period_ns - on_ns);
  }
  void pulses(int count, Nanoseconds on_ns, Nanoseconds period_ns = kPeriod) {
    for (int n = 0; n < count; ++n) pulse(on_ns, period_ns);
  }
  // Largest mean of what ended since the last call; the first of a new train is not looked at.
  void expect_peak(double wanted_A) {
    EXPECT_TRUE(near(window.take_peak_A(), wanted_A, round_off(1 << 20, wanted_A)));
  }

  PwmWindow window{kPeriod};
  Nanoseconds now = 0;
};

TEST(PwmWindow, PeakIsAPulsesChargeOverItsPeriod) {
  Pulses p;
  p.pulses(20, 20'000);
  p.expect_peak(8.0);
  EXPECT_EQ(p.window.take_peak_A(), 0.0);  // nothing ended since
}

// By windows of 50 us and more a clock that is a little fast gave two pulses in 70 us: 11.4 A.
TEST(PwmWindow, LengthIsThePeriodOfTheChipsOwnClock) {
  for (const Nanoseconds period : {49'500, 49'998, 50'002, 50'500}) {
    Pulses p;
    p.pulses(3, 20'000, period);
    p.window.take_peak_A();
    p.pulses(1000, 20'000, period);
    p.expect_peak(20.0 * 20.0 / (static_cast<double>(period) * 1e-3));
  }
}

TEST(PwmWindow, CommutationWithinAPeriodBeginsNoWindow) {
  Pulses p;
  p.pulses(5, 20'000);
  p.window.take_peak_A();
  for (int n = 0; n < 8; ++n) {
    p.window.upper_switch_on();
    p.carry(20.0, 12'000);
    p.window.upper_switch_on();  // the other leg's, for the rest of the pulse
    p.carry(30.0, 8'000);
    p.carry(0.0, 30'000);
    p.pulse(20'000);
  }
  p.expect_peak((20.0 * 12.0 + 30.0 * 8.0) / 50.0);
}

TEST(PwmWindow, AfterAPauseItFollowsThePulsesToTheirNewPhase) {
  Pulses p;
  p.pulses(5, 20'000);
  p.carry(0.0, 217'000);
  p.window.take_peak_A();
  p.pulses(5, 20'000);
  p.pulse(30'000);  // one longer pulse is seen whole
  p.pulse(20'000);
  p.window.upper_switch_on();
  p.expect_peak(12.0);
}

TEST(PwmWindow, TheFirstPeriodAfterAPauseCountsWhole) {
  Pulses p;
  p.pulses(5, 20'000);
  p.carry(0.0, 217'000);
  p.window.take_peak_A();
  p.pulse(40'000);
  p.pulses(5, 5'000);
  p.expect_peak(16.0);
}

TEST(PwmWindow, WithoutEdgesWindowsGoOnAndSplitASteadyCurrentEvenly) {
  Pulses p;
  p.window.upper_switch_on();
  for (int n = 0; n < 200; ++n) p.carry(10.0, 7'000);
  p.expect_peak(10.0);
}

TEST(PwmWindow, CurrentThatFlowsBackIsNoPeak) {
  Pulses p;
  p.carry(-5.0, 400'000);
  EXPECT_EQ(p.window.take_peak_A(), 0.0);
}

}  // namespace
}  // namespace whirl::rack
