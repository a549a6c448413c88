// The guard against an amplifier in closed form, and around the plant's own windings and shunt.
#include "firmware/esc/core/winding_guard.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/near.hpp"
#include "plant/motor/switched_motor.hpp"
#include "plant/sensors/current_shunt.hpp"

namespace fw::esc {
namespace {

using whirl::near;
using whirl::stated;

constexpr double kPeriod_s = 50e-6;
constexpr int kBus_counts = 2720;  // 16.8 V

int counts_of(double ampere) {
  return static_cast<int>(std::lround(ampere * 0.5e-3 * 50.9 * 4096.0 / 3.3));
}

// A pole of 1 kHz behind pulses that last a share of each period and are sampled at their end.
class Amplifier {
 public:
  int pulse(double current_A, double duty) {
    const double rest = std::exp(-kRate * (1.0 - duty)), pulse = std::exp(-kRate * duty);
    out_A_ = out_A_ * rest * pulse + current_A * (1.0 - pulse);
    return counts_of(out_A_);
  }

 private:
  static constexpr double kRate = 2.0 * std::numbers::pi * 1000.0 * kPeriod_s;
  double out_A_ = 0.0;
};

constexpr std::uint32_t pwm(double duty) {
  return static_cast<std::uint32_t>(duty * 3600.0);
}

TEST(WindingGuard, TellsTheWindingCurrentWithinHalfAMillisecond) {
  for (const double duty : {0.1, 0.35, 0.9}) {
    WindingGuard guard;
    Amplifier amplifier;
    for (int k = 0; k < 200; ++k) guard.update(amplifier.pulse(8.0, duty), pwm(duty));
    EXPECT_TRUE(near(guard.current_A(), 8.0, stated(0.4, "5 %: its series, whole counts"))) << duty;
    for (int k = 0; k < 10; ++k) guard.update(amplifier.pulse(16.0, duty), pwm(duty));
    EXPECT_TRUE(near(guard.current_A(), 16.0, stated(1.0, "e^-10/4 of the step"))) << duty;
  }
}

TEST(WindingGuard, LeavesTheDutyAloneBelowItsLimit) {
  WindingGuard guard;
  Amplifier amplifier;
  for (int k = 0; k < 20'000; ++k) {
    const double duty = 0.2 + 0.6 * (k % 100) / 100.0;
    guard.update(amplifier.pulse(18.5, duty), pwm(duty));
    if (k % 20 == 0) guard.tick();
    ASSERT_EQ(guard.allowed(pwm(duty), kBus_counts), pwm(duty)) << k;
  }
  EXPECT_FALSE(guard.tripped());
}

TEST(WindingGuard, DroopsByTwoFifthsOfAVoltPerAmpere) {
  WindingGuard guard;
  Amplifier amplifier;
  for (int k = 0; k < 100; ++k) guard.update(amplifier.pulse(25.0, 0.5), 1800);
  const double less_V = (1800.0 - guard.allowed(1800, kBus_counts)) / 3600.0 * 16.8;
  EXPECT_TRUE(near(less_V, 0.4 * 3.8, stated(0.16, "whole counts, the series")));
}

TEST(WindingGuard, BrakedRotorGetsTwoFifths) {
  WindingGuard guard;
  Amplifier amplifier;
  for (int k = 0; k < 100; ++k) guard.update(amplifier.pulse(15.0, 0.5), 1800);
  EXPECT_EQ(guard.allowed(1800, kBus_counts), 1800u);
  const double less_V = (1800.0 - guard.allowed(1800, kBus_counts, true)) / 3600.0 * 16.8;
  EXPECT_TRUE(near(less_V, 0.4 * (15.0 - 0.4 * 21.2), stated(0.16, "whole counts, the series")));
}

TEST(WindingGuard, CutsThePulseAfterOneFarTooHighAndTripsAfterThree) {
  WindingGuard guard;
  Amplifier amplifier;
  for (int k = 0; k < 100; ++k) guard.update(amplifier.pulse(15.0, 0.4), 1440);
  guard.update(amplifier.pulse(31.0, 0.4), 1440);
  EXPECT_EQ(guard.allowed(1440, kBus_counts), WindingGuard::kShortest);
  EXPECT_FALSE(guard.tripped());
  guard.update(amplifier.pulse(31.0, 0.4), 1440);
  guard.update(amplifier.pulse(31.0, 0.4), 1440);
  EXPECT_TRUE(guard.tripped());
}

// While pulses are too short to tell, the last value must not hold the duty down for ever.
TEST(WindingGuard, ForgetsACurrentThatNoPulseKeepsUp) {
  WindingGuard guard;
  Amplifier amplifier;
  for (int k = 0; k < 100; ++k) guard.update(amplifier.pulse(25.0, 0.9), pwm(0.9));
  EXPECT_LT(guard.allowed(1800, kBus_counts), 1800u);
  for (int k = 0; k < 20; ++k) guard.update(amplifier.pulse(0.5, 0.03), 120);
  EXPECT_EQ(guard.allowed(1800, kBus_counts), 1800u);
}

TEST(WindingGuard, TripsWhenTheDroopLastsLongerThanAnyStep) {
  WindingGuard guard;
  Amplifier amplifier;
  int k = 0;
  for (; k < 20'000 && !guard.tripped(); ++k) {
    guard.update(amplifier.pulse(25.0, 0.4), 1440);
    if (k % 20 == 0) guard.tick();
  }
  EXPECT_TRUE(near(k * kPeriod_s, 0.25, stated(0.01, "and the amplifier's rise")));
}

// The limit is the motor's, in true amperes: a shunt that reads 10 % high has a gain of 1/1.1.
TEST(WindingGuard, LimitFollowsTheMotorAndTheShuntsGain) {
  WindingGuard guard;
  guard.configure(8.0f, 1.0f / 1.1f);
  Amplifier amplifier;
  for (int k = 0; k < 100; ++k) guard.update(amplifier.pulse(1.1 * 7.8, 0.4), 1440);
  EXPECT_EQ(guard.allowed(1440, kBus_counts), 1440u);
  for (int k = 0; k < 100; ++k) guard.update(amplifier.pulse(1.1 * 9.0, 0.4), 1440);
  EXPECT_LT(guard.allowed(1440, kBus_counts), 1440u);
}

TEST(WindingGuard, BusCurrentThatStaysTooHighTrips) {
  WindingGuard guard;
  guard.update(counts_of(25.0), 3600);
  guard.update(counts_of(25.0), 3600);
  EXPECT_FALSE(guard.tripped());
  guard.update(counts_of(25.0), 3600);
  EXPECT_TRUE(guard.tripped());
}

// A rotor that stands takes bus voltage x duty / resistance: a bound that believes in a back-EMF which
// is not there would drive 44 A through it.
TEST(WindingGuard, HoldsARotorThatStandsUnderThirtyAmperes) {
  whirl::plant::MotorParams params;
  params.resistance_ohm = 0.09;
  params.winding_resistance_ohm = 0.07;
  params.inductance_H = 45e-6;
  whirl::plant::SwitchedMotor motor(params);
  whirl::plant::CurrentShunt shunt({}, 1);
  WindingGuard guard;
  motor.set_angle(1.0);  // sector 0
  motor.set_bus(16.8);
  motor.block();
  double peak_A = 0.0;
  const auto run = [&](bool on, double share) {
    motor.set_bridge(whirl::plant::six_step(0, on, false));
    const auto books = motor.run(share * kPeriod_s);
    if (share > 0.0) shunt.flow(books.bus_charge_C / (share * kPeriod_s), share * kPeriod_s);
    peak_A = std::max(peak_A, motor.peak_current_A());
  };
  const int zero = counts_of(shunt.sample_A());
  std::uint32_t duty = 0;
  for (int k = 0; k < 4000 && !guard.tripped(); ++k) {
    const double wanted_V = std::min(4.0, 1.0 + 0.004 * k);  // 37.5 ms: as a brake would take it
    run(true, duty / 3600.0);
    guard.update(counts_of(shunt.sample_A()) - zero, duty);
    run(false, 1.0 - duty / 3600.0);
    duty = guard.allowed(static_cast<std::uint32_t>(wanted_V / 16.8 * 3600.0), kBus_counts);
  }
  EXPECT_GT(peak_A, 22.0);
  EXPECT_LT(peak_A, 30.0);
}

}  // namespace
}  // namespace fw::esc
