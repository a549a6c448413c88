// The power stage without a chip: six wires driven by hand.
#include "io_bridges/rack/models/power_stage.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "base/near.hpp"

namespace whirl::rack {
namespace {

constexpr Nanoseconds kUs = 1000, kMs = 1'000'000;
constexpr double kDivider = 1.5 / 11.5;

struct Stand {
  explicit Stand(bool swap_wires = false) : Stand(params(swap_wires)) {}
  explicit Stand(const PowerStageParams& params) : stage(params, 1, "motor") {
    for (int leg = 0; leg < 3; ++leg) {
      for (const bool upper : {false, true}) {
        auto& slot = wire[static_cast<std::size_t>(leg)][upper ? 1 : 0];
        slot = std::make_unique<io::Wire>("switch");
        stage.wire(leg, upper, *slot);
        driver[static_cast<std::size_t>(leg)][upper ? 1 : 0] = slot->add_driver();
      }
    }
    stage.on_shoot_through([this](int leg, Nanoseconds start_ns, Nanoseconds end_ns) {
      shots.push_back({leg, end_ns - start_ns});
    });
    load(0.0);
  }
  static PowerStageParams params(bool swap_wires) {
    PowerStageParams p;
    p.swap_wires = swap_wires;
    p.shunt = {.gain_tolerance = 0.0,
               .offset_low_A = 4.3,
               .offset_high_A = 4.3,
               .warm_up_A = 0.0,
               .wander_A = 0.0,
               .noise_A = 0.0,
               .noise_per_A = 0.0};
    return p;
  }
  void load(double brake_Nm, double air_Nm_s2 = 2.3e-7) {
    stage.set_load(
        {.torque_Nm_s2 = air_Nm_s2, .brake_Nm = brake_Nm, .source_V = 16.0, .source_ohm = 0.03},
        now);
  }
  void set(int leg, bool upper, bool on) {
    wire[static_cast<std::size_t>(leg)][upper ? 1 : 0]->drive(
        driver[static_cast<std::size_t>(leg)][upper ? 1 : 0], on ? io::Drive::high : io::Drive::low,
        now);
  }
  void off() {
    for (int leg = 0; leg < 3; ++leg) set(leg, true, false), set(leg, false, false);
  }
  // One PWM period at the pattern that the rotor's true angle asks for.
  void period(double duty, Nanoseconds length_ns = 50 * kUs) {
    static constexpr int kHigh[] = {0, 0, 1, 1, 2, 2}, kLow[] = {1, 2, 2, 0, 0, 1};
    const auto sector =
        static_cast<std::size_t>(plant::sector_of(stage.motor().electrical_angle_rad()));
    if (sector != last) off(), last = sector;
    const int high = reversed ? kLow[sector] : kHigh[sector];
    const int low = reversed ? kHigh[sector] : kLow[sector];
    set(low, false, true);
    set(high, true, true);
    const auto on_ns = static_cast<Nanoseconds>(duty * 50e3);
    now += on_ns;
    set(high, true, false);
    now += length_ns - on_ns;
  }
  void spin(double duty, int periods) {
    for (int i = 0; i < periods; ++i) period(duty);
  }

  bool reversed = false;  // torque against the propeller's direction
  PowerStage stage;
  std::array<std::array<std::unique_ptr<io::Wire>, 2>, 3> wire;
  std::array<std::array<int, 2>, 3> driver{};
  std::vector<std::pair<int, Nanoseconds>> shots;
  std::size_t last = 6;
  Nanoseconds now = 0;
};

TEST(PowerStage, UndrivenSwitchesAreOff) {
  Stand s;
  s.now = 10 * kMs;
  EXPECT_EQ(s.stage.report(s.now).bridge_current_A, 0.0);
  EXPECT_EQ(s.stage.motor().speed_radps(), 0.0);
  EXPECT_TRUE(s.shots.empty());
}

TEST(PowerStage, DividersAndShuntGiveWhatTheSchematicSays) {
  Stand s;
  s.now = 5 * kMs;
  EXPECT_TRUE(near(s.stage.bus_V(s.now), 16.0 * kDivider, stated(1e-4, "capacitor charged")));
  EXPECT_TRUE(near(s.stage.shunt_V(s.now), 4.3 * 0.5e-3 * 50.9, round_off(1, 1)));
  s.set(1, true, true);  // one upper switch: its phase at the bus, no current
  s.now += kUs;
  EXPECT_TRUE(near(s.stage.phase_V(1, s.now), 16.0 * kDivider, stated(1e-4, "as above")));
}

TEST(PowerStage, StalledCurrentRisesWithTheWindingsTimeConstant) {
  Stand s;
  s.load(1.0);  // held: 1 N m
  s.now = 5 * kMs;
  s.set(1, false, true);
  s.set(0, true, true);
  s.now += 600 * kUs;  // L/R is 167 us; the bus sags by the supply's 30 mohm meanwhile
  s.stage.bus_V(s.now);
  const double R = 0.12 + 0.03, tau_s = 2.0e-5 / R;
  const double expected_A = 16.0 / R * -std::expm1(-600e-6 / tau_s);
  EXPECT_TRUE(near(s.stage.motor().phase_currents_A()[0], expected_A,
                   stated(0.02 * expected_A, "the bus capacitor delays by 14 us")));
  EXPECT_EQ(s.stage.motor().speed_radps(), 0.0);
}

TEST(PowerStage, SwappedWiresExchangeTwoPhasesAtTheBridgeAndAtTheConverter) {
  for (const bool swapped : {false, true}) {
    Stand s(swapped);
    s.load(1.0);
    s.now = 5 * kMs;
    s.set(1, false, true);
    s.set(0, true, true);
    s.now += 100 * kUs;
    EXPECT_TRUE(near(s.stage.phase_V(1, s.now), 0.0,
                     stated(0.05, "tied to ground; the bus is 2.1 V here")));
    const auto current_A = s.stage.motor().phase_currents_A();
    EXPECT_LT(current_A[swapped ? 2 : 1], -10.0);
    EXPECT_EQ(current_A[swapped ? 1 : 2], 0.0);
  }
}

TEST(PowerStage, AMotorThatTurnsBackwardsIsToldOnce) {
  for (const bool reversed : {false, true}) {
    Stand s;
    int told = 0;
    s.stage.on_backwards([&](Nanoseconds) { ++told; });
    s.reversed = reversed;
    for (int ms = 0; ms < 400; ++ms) {
      s.spin(0.3, 20);
      s.stage.report(s.now);
    }
    EXPECT_EQ(s.stage.motor().speed_radps() < -100.0, reversed) << s.stage.motor().speed_radps();
    EXPECT_EQ(told, reversed ? 1 : 0);
  }
}

TEST(PowerStage, OverlapOfOneLegIsToldWithItsDuration) {
  Stand s;
  s.now = kMs;
  s.set(2, true, true);
  s.now += kUs;
  s.set(2, false, true);
  s.now += 300;
  s.set(2, true, false);
  ASSERT_EQ(s.shots.size(), 1u);
  EXPECT_EQ(s.shots[0], (std::pair<int, Nanoseconds>{2, 300}));
  s.set(2, true, true);  // on and off at one instant: no overlap
  s.set(2, true, false);
  s.set(0, true, true);  // another leg's switch is no short circuit
  s.now += kUs;
  s.off();
  EXPECT_EQ(s.shots.size(), 1u);
}

void expect_balanced(const io::ShaftState& sum) {
  const double spent_J =
      sum.copper_J + sum.diode_J + sum.no_load_J + sum.magnetic_J + sum.kinetic_J + sum.air_J;
  EXPECT_TRUE(near(sum.electrical_in_J, spent_J,
                   stated(1e-3 * spent_J, "the switched motor's own balance is 1e-4")));
  EXPECT_TRUE(near(
      sum.source_J, sum.feed_J + sum.capacitor_J + sum.electrical_in_J,
      stated(1e-9 * sum.source_J, "closed by construction; with the step's first voltage 5e-3")));
}

TEST(PowerStage, BooksBalanceAndTheRotorFindsItsSpeed) {
  Stand s;
  s.now = 5 * kMs;
  s.stage.report(s.now);
  s.spin(0.4, 20'000);  // one second
  const io::ShaftState sum = s.stage.report(s.now);
  expect_balanced(sum);
  s.spin(0.4, 4'000);
  const io::ShaftState now = s.stage.report(s.now);
  EXPECT_GT(now.speed_radps, 0.8 * 0.4 * 16.0 / 0.01005 * 0.8);  // within the drop of R i
  EXPECT_LT(now.speed_radps, 0.4 * 16.0 / 0.01005);              // and below no load
  // Steady: the air takes what its coefficient says, the supply gives what the bridge takes.
  EXPECT_TRUE(near(now.air_torque_Nm, 2.3e-7 * now.speed_radps * now.speed_radps,
                   stated(0.02 * now.air_torque_Nm, "ripple of speed over commutations")));
  EXPECT_TRUE(near(now.source_current_A, now.bridge_current_A,
                   stated(0.01 * now.bridge_current_A, "capacitor at both ends")));
  EXPECT_TRUE(s.shots.empty());
}

// The same pulses by a clock that is 0.01 % fast: no window has two of them. The rotor is held and the shaft's phase with
// it, so that each pulse is like the last.
TEST(PowerStage, BusPeakIsThatOfOnePeriodByAFastClockToo) {
  for (const Nanoseconds length : {50'000, 49'995}) {
    Stand s;
    s.load(1.0);
    s.now = 5 * kMs;
    for (int n = 0; n < 400; ++n) s.period(0.2, length);
    s.stage.report(s.now);
    for (int n = 0; n < 400; ++n) s.period(0.2, length);
    const io::ShaftState held = s.stage.report(s.now);
    EXPECT_GT(held.bridge_current_A, 1.0);
    EXPECT_TRUE(near(held.bridge_peak_A, held.bridge_current_A,
                     stated(0.01 * held.bridge_current_A, "each period is like the next")));
  }
}

// One longer pulse counts as a whole, wherever the PWM's periods lie between the milliseconds.
TEST(PowerStage, BusPeakIsThatOfTheOneLongPulse) {
  Stand s;
  s.load(1.0);
  s.now = 5 * kMs + 25 * kUs;
  for (int n = 0; n < 400; ++n) s.period(0.2);
  s.stage.report(s.now);
  s.period(0.6);
  const double its_own_A = s.stage.report(s.now).bridge_current_A;
  for (int n = 0; n < 3; ++n) s.period(0.2);
  EXPECT_TRUE(near(s.stage.report(s.now).bridge_peak_A, its_own_A,
                   stated(1e-6 * its_own_A, "bounds are edges: nothing is split")));
}

TEST(PowerStage, BrakeStopsTheRotorAsItsTorqueAndInertiaSay) {
  Stand s;
  s.now = 5 * kMs;
  s.spin(0.4, 10'000);
  s.off();
  const double speed = s.stage.motor().speed_radps();
  s.load(0.5, 0.0);
  const double friction_Nm = 0.01005 * 1.0, J = 3.752e-5;
  const double stops_s = speed * J / (0.5 + friction_Nm);
  s.now += static_cast<Nanoseconds>(0.9 * stops_s * 1e9);
  s.stage.bus_V(s.now);
  EXPECT_TRUE(near(s.stage.motor().speed_radps(), 0.1 * speed, stated(0.02 * speed, "currents")));
  s.now += static_cast<Nanoseconds>(0.2 * stops_s * 1e9);
  s.stage.bus_V(s.now);
  EXPECT_EQ(s.stage.motor().speed_radps(), 0.0);
  s.load(0.0);
  s.spin(0.4, 10'000);
  EXPECT_GT(s.stage.motor().speed_radps(), 100.0);  // released, it turns again
}

// ---- The converter's channels and the capacitor as they are bought

struct Pins {
  explicit Pins(const PowerStageParams& params) : stage(params, 1, "motor") {
    stage.set_load({.source_V = 12.0, .source_ohm = 0.03}, 0);
  }
  PowerStage stage;
};

TEST(PowerStageParts, PinShowsDividerThenGainThenOffset) {
  PowerStageParams params = Stand::params(false);
  params.pins[PowerStageParams::kBus] = {.divider = 0.017, .gain = -0.002, .offset_V = 1.5e-3};
  Pins exact(Stand::params(false)), off(params);
  const double drawn = exact.stage.bus_V(50 * kMs), shown = off.stage.bus_V(50 * kMs);
  EXPECT_TRUE(near(drawn, 12.0 * kDivider, stated(1e-6, "charged")));
  EXPECT_TRUE(near(shown, 0.998 * 1.017 * drawn + 1.5e-3, round_off(8, 1.6)));
}

TEST(PowerStageParts, NoiseIsWhiteAndEachChannelsOwn) {
  PowerStageParams params = Stand::params(false);
  for (PinErrors& pin : params.pins) pin.noise_V = 2e-3;
  Pins noisy(params), exact(Stand::params(false));
  const double truth = exact.stage.bus_V(50 * kMs);
  double sum = 0.0, squares = 0.0, product = 0.0;
  constexpr int kSamples = 4000;
  for (int n = 0; n < kSamples; ++n) {
    const double bus = noisy.stage.bus_V(50 * kMs) - truth;
    const double shunt = noisy.stage.shunt_V(50 * kMs) - exact.stage.shunt_V(50 * kMs);
    sum += bus, squares += bus * bus, product += bus * shunt;
  }
  EXPECT_TRUE(near(sum / kSamples, 0.0, stated(1e-4, "three standard errors")));
  EXPECT_TRUE(near(std::sqrt(squares / kSamples), 2e-3, stated(7e-5, "three standard errors")));
  EXPECT_TRUE(near(product / kSamples / 4e-6, 0.0, stated(0.05, "three standard errors")));
}

// Four microseconds after an edge the capacitor has given hardly any charge: without a resistance the bus
// stands, with it the current drops over source and capacitor in parallel.
TEST(PowerStageParts, SeriesResistanceDropsTheBusWithTheEdge) {
  PowerStageParams params = Stand::params(false);
  params.bus_esr_ohm = 0.06;
  Stand exact, real(params);
  for (Stand* s : {&exact, &real}) {
    s->load(0.5);  // held
    s->now = 20 * kMs;
    s->stage.report(s->now);
    s->set(0, true, true), s->set(1, false, true);
    s->now += 4 * kUs;
  }
  const double sag_V = (exact.stage.bus_V(exact.now) - real.stage.bus_V(real.now)) / kDivider;
  const double bridge_A = std::abs(real.stage.motor().bus_current_A());
  EXPECT_GT(bridge_A, 2.5);
  // Both capacitors gave some 7 uC of their 470 uF; the one without resistance alone shows it.
  EXPECT_TRUE(near(sag_V, bridge_A * 0.06 * 0.03 / 0.09, stated(0.015, "7 uC of 470 uF")));
  // In the long run the capacitor carries nothing, and its resistance does not matter.
  const double late_exact = exact.stage.bus_V(exact.now + 5 * kMs);
  const double late_real = real.stage.bus_V(real.now + 5 * kMs);
  EXPECT_TRUE(near(late_real, late_exact, stated(1e-4, "settled")));
}

TEST(PowerStageParts, BooksBalanceOverASeriesResistanceAndUnlikePhases) {
  PowerStageParams params = Stand::params(false);
  params.bus_esr_ohm = 0.06;
  params.motor.phases.impedance = {0.03, -0.02, -0.01};
  Stand s(params);
  s.now = 5 * kMs;
  s.stage.report(s.now);
  s.spin(0.4, 20'000);
  expect_balanced(s.stage.report(s.now));
}

}  // namespace
}  // namespace whirl::rack
