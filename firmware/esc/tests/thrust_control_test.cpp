// Modes 4 and 5 in closed loop with a rotor in moving air, the shunt's noise and a sagging supply.
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/near.hpp"
#include "firmware/esc/tests/air_bench.hpp"

namespace fw::esc {
namespace {

using whirl::near;
using whirl::stated;

TEST(ThrustByPower, HoldsThrustInADowndraftThatTheRpmControllerGivesWayTo) {
  for (double down : {0.8, 2.2, 4.2}) {
    AirBench by_rpm(Mode::thrust_by_speed), by_power(Mode::thrust_by_power);
    for (AirBench* bench : {&by_rpm, &by_power}) {
      bench->start(3.2);
      bench->down_mps = down;
      bench->hold(3.2, 1500);
    }
    const double lost = 3.2 - by_rpm.mean_thrust_N(500), off = 3.2 - by_power.mean_thrust_N(500);
    EXPECT_GT(lost, 0.03 * down * 3.2);
    EXPECT_LT(std::abs(off), 0.005 * 3.2) << down;
    EXPECT_TRUE(by_power.core.estimator().observable());
    const float ls = by_power.core.estimator().solution().ls;
    EXPECT_TRUE(near(ls, down / (by_power.speed * kRadius_m), stated(0.002, "set-point, filters")));
  }
}

TEST(ThrustByPower, AnUpdraftLeavesItWithTheStaticMapAndItSaysSo) {
  AirBench by_rpm(Mode::thrust_by_speed), by_power(Mode::thrust_by_power);
  for (AirBench* bench : {&by_rpm, &by_power}) {
    bench->start(3.2);
    bench->down_mps = -2.0;
    bench->hold(3.2, 1500);
  }
  EXPECT_FALSE(by_power.core.estimator().observable());
  EXPECT_TRUE(
      near(by_power.mean_thrust_N(500), by_rpm.mean_thrust_N(500), stated(0.01, "same map")));
}

// Told that air comes from above only, it expects half of what power cannot show: 1.7 % of thrust.
TEST(ThrustByPower, WithAirFromAboveOnlyItErrsLittleWherePowerTellsNothing) {
  Calibration one_sided = calibrated(Mode::thrust_by_power);
  one_sided.shared_power = 2.0f;
  one_sided.free_air.q2 *= 0.98f;  // so that still air reads as more power than there is
  AirBench bench(one_sided);
  bench.start(3.2);
  EXPECT_FALSE(bench.core.estimator().observable());
  EXPECT_TRUE(near(bench.mean_thrust_N(500), 3.2 * 1.017, stated(0.01, "set-point step")));
}

TEST(ThrustByPower, BeyondItsCalibratedSpeedsItIsTheStaticMap) {
  const auto lost_N = [](const PowerRange& range, bool& observable) {
    Calibration c = calibrated(Mode::thrust_by_power);
    c.power = range;
    AirBench bench(c);
    bench.start(3.2);
    bench.down_mps = 4.2;
    bench.hold(3.2, 1500);
    observable = bench.core.estimator().observable();
    return 3.2 - bench.mean_thrust_N(500);
  };
  bool observable = false;
  EXPECT_LT(lost_N({.from_radps = 300.0f, .to_radps = 700.0f}, observable), 0.02);
  EXPECT_TRUE(observable);
  for (const PowerRange& elsewhere : {PowerRange{.from_radps = 600.0f, .to_radps = 900.0f},
                                      PowerRange{.from_radps = 200.0f, .to_radps = 400.0f}}) {
    EXPECT_GT(lost_N(elsewhere, observable), 0.4);
    EXPECT_FALSE(observable);
  }
}

// Seconds after power-up the shunt's zero drifts by more than inflow takes; after two minutes it does
// not.
TEST(ThrustByPower, WaitsForTheShuntToSettle) {
  Calibration cold = calibrated(Mode::thrust_by_power);
  cold.sense.warm_up_A = 0.4f;
  for (const bool settled : {false, true}) {
    AirBench bench(cold);
    bench.hold(0.0, settled ? 120'000 : 600);
    bench.start(3.2);
    bench.down_mps = 1.2;
    bench.hold(3.2, 1500);
    EXPECT_EQ(bench.core.estimator().observable(), settled);
    EXPECT_EQ(3.2 - bench.mean_thrust_N(500) < 0.05, settled);
  }
}

// Who flies by it is told so: by the flag of what was never calibrated, in the modes that go by power alone.
TEST(ThrustByPower, TellsThatItsCurrentSenseIsNotWarm) {
  for (const Mode mode : {Mode::thrust_by_power, Mode::power, Mode::thrust_by_speed, Mode::speed}) {
    Calibration cold = calibrated(mode);
    cold.sense.warm_up_A = 0.4f;
    AirBench bench(cold);
    EXPECT_EQ((bench.core.flags() & flag_uncalibrated) != 0, goes_by_power(mode));
    bench.hold(0.0, 90'000);
    EXPECT_EQ((bench.core.flags() & flag_uncalibrated) != 0, goes_by_power(mode));
    bench.hold(0.0, 12'000);
    EXPECT_EQ(bench.core.flags() & flag_uncalibrated, 0);
    Calibration never = calibrated(mode);
    never.identified = false;
    EXPECT_NE(Core(never).flags() & flag_uncalibrated, 0);
    EXPECT_EQ(AirBench(mode).core.flags() & flag_uncalibrated, 0);  // told that it is warm
  }
}

// A blade on which inflow takes a fifth less power per 20 % of speed over the middle.
TEST(ThrustByPower, FollowsTheSpeedsEffectOnWhatInflowTakes) {
  Calibration told = calibrated(Mode::thrust_by_power);
  told.power = {.from_radps = 300.0f, .to_radps = 500.0f, .speed_effect = -1.0f};
  AirBench with(told), without(calibrated(Mode::thrust_by_power));
  for (AirBench* bench : {&with, &without}) {
    bench->start(3.2);
    bench->down_mps = 4.2;
    bench->hold(3.2, 1500);
  }
  ASSERT_GT(with.speed, 440.0);  // over the middle: it thinks less of the same loss of power
  EXPECT_LT(with.mean_thrust_N(500), without.mean_thrust_N(500) - 0.03);
}

TEST(ThrustByPower, WithoutACalibrationItIsTheStaticMap) {
  AirBench bench(Mode::thrust_by_power);
  Calibration bare = calibrated(Mode::thrust_by_power);
  bare.rotor = {};
  bare.identified = false;
  bench.hold(0.0, 10);
  ASSERT_TRUE(bench.core.recalibrate(bare));
  bench.start(3.2);
  EXPECT_TRUE(near(bench.mean_thrust_N(500), 3.2, stated(0.02, "set-point step")));
}

// Told that an updraft may share this power, it concludes nothing from it.
TEST(ThrustByPower, ConcludesNothingFromPowerThatAnUpdraftMayShare) {
  for (double down : {2.2, 4.2}) {
    AirBench bench(Mode::thrust_by_power);
    Calibration cautious = calibrated(Mode::thrust_by_power);
    cautious.shared_power = 0.94f;
    bench.hold(0.0, 10);
    ASSERT_TRUE(bench.core.recalibrate(cautious));
    bench.start(3.2);
    bench.down_mps = down;
    bench.hold(3.2, 1500);
    const double lost = 3.2 - bench.mean_thrust_N(500);
    EXPECT_EQ(bench.core.estimator().observable(), down > 4.0) << down;
    EXPECT_EQ(lost<0.03, down> 4.0) << lost;
  }
}

TEST(ThrustByPower, RisesAsTheRpmControllerDoesOnAnySupply) {
  for (double volts : {14.0, 15.7, 16.8}) {
    AirBench bench(Mode::thrust_by_power);
    bench.shunt_noise_A = 0.01;
    bench.start(2.0);
    bench.bus_V = volts;
    bench.hold(2.0, 500);
    const std::size_t start = bench.thrust_log.size();
    bench.hold(3.2, 600);
    const auto reaches = [&](double T) {
      return std::find_if(bench.thrust_log.begin() + static_cast<long>(start),
                          bench.thrust_log.end(), [&](double x) { return x >= T; }) -
             bench.thrust_log.begin();
    };
    EXPECT_LT(reaches(3.08) - reaches(2.12), 50) << volts << " V";
    EXPECT_LT(*std::max_element(bench.thrust_log.begin() + static_cast<long>(start),
                                bench.thrust_log.end()),
              3.2 + 0.10 * 1.2);
    for (std::size_t i = start + 150; i < bench.thrust_log.size(); ++i) {
      ASSERT_TRUE(near(bench.thrust_log[i], 3.2, stated(0.064, "2 % after 150 ms"))) << i - start;
    }
    EXPECT_LT(bench.peak_A, 21.0);
  }
}

// The wind stays while the rotor gains a fifth in speed: what it takes changes at once, not with the
// smoothing of power.
TEST(ThrustByPower, RisesInADowndraftAsInStillAir) {
  AirBench bench(Mode::thrust_by_power);
  bench.down_mps = 3.5;
  bench.start(2.0);
  ASSERT_TRUE(bench.core.estimator().observable());
  const std::size_t start = bench.thrust_log.size();
  bench.hold(3.2, 600);
  EXPECT_LT(*std::max_element(bench.thrust_log.begin() + static_cast<long>(start),
                              bench.thrust_log.end()),
            3.2 + 0.05 * 1.2);
  for (std::size_t i = start + 60; i < bench.thrust_log.size(); ++i) {
    ASSERT_TRUE(near(bench.thrust_log[i], 3.2, stated(0.032, "1 % after 60 ms"))) << i - start;
  }
}

// A falling rotor coasts and its current has gaps, but the wind has not gone meanwhile.
TEST(ThrustByPower, FallsInADowndraftAsInStillAir) {
  AirBench bench(Mode::thrust_by_power);
  bench.down_mps = 3.5;
  bench.start(3.2);
  ASSERT_TRUE(bench.core.estimator().observable());
  const std::size_t start = bench.thrust_log.size();
  bench.hold(2.0, 100);
  EXPECT_TRUE(bench.core.estimator().observable());
  bench.hold(2.0, 500);
  EXPECT_GT(*std::min_element(bench.thrust_log.begin() + static_cast<long>(start),
                              bench.thrust_log.end()),
            2.0 - 0.05 * 1.2);
  for (std::size_t i = start + 100; i < bench.thrust_log.size(); ++i) {
    ASSERT_TRUE(near(bench.thrust_log[i], 2.0, stated(0.04, "2 % after 100 ms"))) << i - start;
  }
}

// No pulse carries current and the rotor seems to keep its speed: what power says then is no power of the air's.
TEST(ThrustEstimator, MixesNothingOfGapsIntoWhatWasTold) {
  const Calibration c = calibrated(Mode::thrust_by_power);
  ThrustEstimator estimator(c, 1e-3f);
  const float w = 480.0f, bus_V = 16.4f;
  const RotorPoint air = at_inflow(kRotor, 3.5f / (w * static_cast<float>(kRadius_m)));
  const float current_A = 1.0f + air.CP * w * w / c.motor.Kt_NmpA;
  const float duty = (c.motor.Kt_NmpA * w + c.losses.loss_ohm * current_A) / bus_V;
  for (int ms = 0; ms < 500; ++ms) estimator.update(bus_V, duty, duty * current_A, w, 0.0f);
  ASSERT_TRUE(estimator.observable());
  const float told = estimator.power_ratio();
  for (int ms = 0; ms < 100; ++ms) estimator.update(bus_V, 0.036f, 0.0f, w, 0.0f);
  EXPECT_TRUE(estimator.observable());
  EXPECT_TRUE(near(estimator.power_ratio(), told,
                   stated(0.1 * (1.0 - told), "until the filters see the gaps, 3 ms each")));
}

// Where gaps last, what was told of the wind before them is not believed for ever.
TEST(ThrustByPower, GivesUpAToldInflowWhereGapsLast) {
  Calibration rippling = calibrated(Mode::thrust_by_power);
  rippling.motor.inductance_H = 30e-6f;  // 1.1 N has gaps, 3.2 N has none
  AirBench bench(rippling);
  bench.down_mps = 3.5;
  bench.start(3.2);
  ASSERT_TRUE(bench.core.estimator().observable());
  bench.hold(0.6, 150);
  EXPECT_TRUE(bench.core.estimator().observable());
  bench.hold(0.6, 250);
  EXPECT_FALSE(bench.core.estimator().observable());
}

TEST(ThrustByPower, StaysQuietUnderTheNoiseOfTheShunt) {
  AirBench bench(Mode::thrust_by_power);
  bench.shunt_noise_A = 0.01;  // of a millisecond's mean
  bench.down_mps = 3.0;
  bench.start(3.2);
  bench.hold(3.2, 3000);
  const double mean = bench.mean_thrust_N(2000);
  double square = 0.0;
  for (std::size_t i = bench.thrust_log.size() - 2000; i < bench.thrust_log.size(); ++i) {
    square += (bench.thrust_log[i] - mean) * (bench.thrust_log[i] - mean);
  }
  EXPECT_LT(std::sqrt(square / 2000), 0.01 * 3.2);
}

// The sensitivity that is told is the one that an offset really has.
TEST(ThrustByPower, KnowsWhatAnAmpereTooMuchDoesToIt) {
  AirBench right(Mode::thrust_by_power), wrong(Mode::thrust_by_power);
  wrong.shunt_offset_A = 0.01;
  for (AirBench* bench : {&right, &wrong}) {
    bench->down_mps = 3.0;
    bench->start(3.2);
    bench->hold(3.2, 1000);
  }
  // Too much current reads as too little inflow, so thrust is believed larger than it is and falls.
  const double shift_N = wrong.mean_thrust_N(500) - right.mean_thrust_N(500);
  const double told_N = -0.01 * right.core.estimator().thrust_per_ampere();
  EXPECT_LT(shift_N, -0.01);
  EXPECT_TRUE(near(shift_N, told_N, stated(0.25 * std::abs(told_N), "a secant for a slope")));
}

TEST(Power, HoldsTheAerodynamicPowerInMovingAir) {
  for (double down : {0.0, 4.0}) {
    AirBench bench(Mode::power);
    bench.start(18.0);
    bench.down_mps = down;
    bench.hold(18.0, 2000);
    EXPECT_TRUE(near(bench.power_W(), 18.0, stated(0.1, "set-point step of 0.03 W, filters")));
  }
}

}  // namespace
}  // namespace fw::esc
