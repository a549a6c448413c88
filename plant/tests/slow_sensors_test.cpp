#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/near.hpp"
#include "plant/sensors/barometer.hpp"
#include "plant/sensors/current_shunt.hpp"
#include "plant/sensors/gps.hpp"
#include "plant/sensors/load_cell.hpp"
#include "plant/sensors/magnetometer.hpp"
#include "plant/sensors/motion_capture.hpp"
#include "plant/tests/allan.hpp"

namespace whirl::plant {
namespace {

using Eigen::Vector3d;

BarometerParams quiet_barometer() {
  BarometerParams p;
  p.noise_density_Pa = p.drift_Pa = p.turn_on_bias_Pa = 0.0;
  return p;
}

TEST(Barometer, PerfectPartReadsTheAir) {
  Barometer baro(quiet_barometer(), 1);
  EXPECT_EQ(baro.sample_Pa(0.01, {}), 101325.0);
}

// 8.83 N over four 10 in discs are 43.6 Pa; a tenth of it is 36 cm of height.
TEST(Barometer, SpinningRotorsRaiseThePressureByAShareOfDiscLoading) {
  Barometer baro(quiet_barometer(), 1);
  Truth truth;
  baro.sample_Pa(0.01, truth);
  truth.thrust_N = {2.2065, 2.2065, 2.2065, 2.2065};
  double reading = 0.0;
  for (int k = 0; k < 200; ++k) reading = baro.sample_Pa(0.01, truth);
  EXPECT_TRUE(near(reading - 101325.0, 4.355, stated(0.01, "disc area to 4 digits")));
}

TEST(Barometer, WindOverTheFrameLowersThePressure) {
  Barometer baro(quiet_barometer(), 1);
  Truth truth;
  truth.v_AB_B_mps = {10.0, 0.0, 0.0};  // 61.25 Pa
  EXPECT_TRUE(near(baro.sample_Pa(0.01, truth), 101325.0 - 6.125, round_off(8, 101325.0)));
}

TEST(Barometer, NoiseHasItsDensity) {
  BarometerParams p = quiet_barometer();
  p.noise_density_Pa = 0.12;
  Barometer baro(p, 2);
  std::vector<double> x;
  x.reserve(400000);
  for (int k = 0; k < 400000; ++k) x.push_back(baro.sample_Pa(0.01, {}));
  EXPECT_TRUE(near(allan_deviation(x, 0.01, 1.0) / 0.12, 1.0, stated(0.1, "issue")));
}

TEST(Magnetometer, NoseNorthReadsTheFieldAndNoseEastReadsItTurned) {
  MagnetometerParams p;
  p.noise_density_T = 0.0;
  p.field_W_T = earth_field_W_T(50e-6, -1.0, 0.0);
  Magnetometer mag(p, 1);
  Truth truth;
  EXPECT_TRUE(near(mag.sample_B_T(0.01, truth).x(), 50e-6 * std::cos(1.0), round_off(8, 5e-5)));
  EXPECT_TRUE(near(mag.sample_B_T(0.01, truth).z(), -50e-6 * std::sin(1.0), round_off(8, 5e-5)));
  truth.q_WB = Eigen::AngleAxisd(M_PI / 2.0, Vector3d::UnitZ());
  EXPECT_TRUE(near(mag.sample_B_T(0.01, truth).y(), -50e-6 * std::cos(1.0), round_off(8, 5e-5)));
}

TEST(Magnetometer, MotorCurrentAddsInProportion) {
  MagnetometerParams p;
  p.noise_density_T = 0.0;
  Magnetometer mag(p, 1);
  Truth off, on;
  on.bus_current_A = {10.0, 0.0, 0.0, 0.0};
  const Vector3d added = mag.sample_B_T(0.01, on) - mag.sample_B_T(0.01, off);
  EXPECT_TRUE(near((added - Vector3d(4e-7, 0.0, 2e-7)).norm(), 0.0, round_off(64, 1e-5)));
}

TEST(Magnetometer, HardIronDoesNotTurnWithTheWorldAndSoftIronStretches) {
  MagnetometerParams p;
  p.noise_density_T = 0.0;
  p.field_W_T = {20e-6, 0.0, 0.0};
  p.hard_iron_T = {0.0, 5e-6, 0.0};
  p.soft_iron(0, 0) = 1.1;
  Magnetometer mag(p, 1);
  Truth truth;
  EXPECT_TRUE(near((mag.sample_B_T(0.01, truth) - Vector3d(22e-6, 5e-6, 0)).norm(), 0.0,
                   round_off(8, 1e-4)));
  truth.q_WB = Eigen::AngleAxisd(M_PI, Vector3d::UnitZ());
  EXPECT_TRUE(near((mag.sample_B_T(0.01, truth) - Vector3d(-22e-6, 5e-6, 0)).norm(), 0.0,
                   round_off(8, 1e-4)));
}

TEST(Gps, FixesComeFiveTimesASecondAndLate) {
  GpsParams p;
  p.wander_level_m = p.wander_down_m = p.white_level_m = p.white_down_m = 0.0;
  Gps gps(p, 1);
  int fixes = 0;
  for (int k = 0; k < 10000; ++k) {
    Truth truth;
    truth.p_WB_W_m.x() = 3.0 * k * 1e-3;
    if (const auto fix = gps.step(k * 1e-3, truth)) {
      ++fixes;
      EXPECT_TRUE(near(k * 1e-3 - fix->taken_s, 0.12, stated(1.01e-3, "asked every 1 ms")));
      EXPECT_TRUE(near(fix->p_WB_W_m.x(), 3.0 * fix->taken_s, round_off(64, 30.0)));
    }
  }
  EXPECT_EQ(fixes, 50);  // taken at 0, 0.2 ... 9.8 s
}

TEST(Gps, PositionErrorWandersWithItsTimeConstant) {
  GpsParams p;
  p.white_level_m = 0.0;
  p.wander_level_m = 1.0;
  Gps gps(p, 3);
  std::vector<double> x;
  for (int k = 0; k < 400000; ++k) {
    if (const auto fix = gps.step(k * 0.2, {})) x.push_back(fix->p_WB_W_m.x());
  }
  double variance = 0.0, at_one_time = 0.0;
  const std::size_t lag = 300;  // 60 s
  for (std::size_t k = lag; k < x.size(); ++k) {
    variance += x[k] * x[k];
    at_one_time += x[k] * x[k - lag];
  }
  const double n = static_cast<double>(x.size() - lag);
  EXPECT_TRUE(near(std::sqrt(variance / n), 1.0, stated(0.1, "1300 independent values")));
  // (1 + 2) e^-2, of two lags of 30 s.
  EXPECT_TRUE(near(at_one_time / variance, 3.0 * std::exp(-2.0), stated(0.06, "statistics")));
}

// A receiver's places and its velocities agree: from fix to fix the place moves as slowly as its velocity
// is wrong, and the further apart two fixes are, the less do they know of each other.
TEST(Gps, PositionErrorMovesNoFasterThanTheVelocityIsWrong) {
  GpsParams p;
  p.white_level_m = 0.0;
  Gps gps(p, 5);
  std::optional<double> last_m;
  double squares = 0.0;
  int moves = 0;
  for (int k = 0; k < 200000; ++k) {
    const auto fix = gps.step(k * 0.2, {});
    if (!fix) continue;
    const double x_m = fix->p_WB_W_m.x();
    if (last_m) squares += std::pow((x_m - *last_m) / 0.2, 2), ++moves;
    last_m = x_m;
  }
  EXPECT_TRUE(near(std::sqrt(squares / moves), 2.0 * 2.12 / 60.0, stated(0.007, "statistics")));
  EXPECT_LT(std::sqrt(squares / moves), p.velocity_level_mps);
}

TEST(Gps, PositionErrorIsTheSameProcessHoweverSeldomItIsAsked) {
  for (const double dt_s : {0.01, 5.0, 300.0}) {
    SmoothWander wander(1.0, 60.0, 11, "wander");
    double squares = 0.0;
    const int n = dt_s < 1.0 ? 1'000'000 : 48'000;
    for (int k = 0; k < n; ++k) squares += std::pow(wander.step(dt_s), 2);
    EXPECT_TRUE(near(std::sqrt(squares / n), 1.0, stated(0.15, "166 independent values at least")))
        << dt_s;
  }
}

// The data sheet: 50 % of the fixes within 2.5 m. One fix each of 4000 receivers, which are independent.
TEST(Gps, HalfOfAllFixesLieWithinTheDataSheetsCircle) {
  std::vector<double> miss_m, miss_mps;
  for (std::uint64_t seed = 1; seed <= 4000; ++seed) {
    const GpsFix fix = Gps({}, seed).measure(60.0, {});
    miss_m.push_back(fix.p_WB_W_m.head<2>().norm());
    miss_mps.push_back(fix.v_WB_W_mps.head<2>().norm());
  }
  const auto middle = [](std::vector<double>& x) {
    std::nth_element(x.begin(), x.begin() + 2000, x.end());
    return x[2000];
  };
  EXPECT_TRUE(near(middle(miss_m), 2.5, stated(0.125, "5 %: three standard errors of a median")));
  EXPECT_TRUE(near(middle(miss_mps), 0.1, stated(0.005, "5 %: three standard errors of a median")));
}

TEST(Gps, ErrorsGrowByTheirScaleAndTheEstimatesWithThem) {
  const GpsFix settled = Gps({}, 7).measure(1.0, {}), fresh = Gps({}, 7).measure(1.0, {}, 5.0);
  EXPECT_TRUE(near((fresh.p_WB_W_m - 5.0 * settled.p_WB_W_m).norm(), 0.0, round_off(16, 50.0)));
  EXPECT_TRUE(near((fresh.v_WB_W_mps - 5.0 * settled.v_WB_W_mps).norm(), 0.0, round_off(16, 5.0)));
  EXPECT_EQ(fresh.level_accuracy_m, 5.0 * settled.level_accuracy_m);
}

TEST(Gps, OutageSilencesAndShiftsNoNoise) {
  Gps steady({}, 1), broken({}, 1);
  broken.add_outage({.start_s = 1.0, .duration_s = 2.0});
  int lost = 0;
  for (int k = 0; k < 5000; ++k) {
    const auto a = steady.step(k * 1e-3, {}), b = broken.step(k * 1e-3, {});
    if (a && !b) ++lost;
    const bool same = !a || !b || a->p_WB_W_m == b->p_WB_W_m;
    EXPECT_TRUE(same) << k;
  }
  EXPECT_EQ(lost, 10);
}

TEST(MotionCapture, TwoHundredFramesASecondWithItsNoise) {
  MotionCapture room({}, 1);
  int frames = 0;
  double square = 0.0;
  for (int k = 0; k < 50000; ++k) {
    if (const auto f = room.step(k * 1e-3, {})) {
      ++frames;
      square += f->p_WB_W_m.squaredNorm();
    }
  }
  EXPECT_EQ(frames, 10000);
  EXPECT_TRUE(near(std::sqrt(square / frames / 3.0), 3e-4, stated(1.5e-5, "30,000 values")));
}

TEST(MotionCapture, SeesNothingOutsideTheRoomOrWhileOccluded) {
  MotionCapture room({}, 1);
  room.add_outage({.start_s = 0.5, .duration_s = 0.25});
  int frames = 0, outside = 0;
  Truth truth;
  for (int k = 0; k < 1000; ++k) frames += room.step(k * 1e-3, truth).has_value();
  EXPECT_EQ(frames, 150);
  truth.p_WB_W_m.x() = 2.6;
  for (int k = 1000; k < 2000; ++k) outside += room.step(k * 1e-3, truth).has_value();
  EXPECT_EQ(outside, 0);
}

// Two equal poles: the step response is 1 - (1 + w t) exp(-w t).
TEST(LoadCell, StepResponseIsThatOfTwoEqualPoles) {
  LoadCellParams p;
  p.thrust_noise_N = p.torque_noise_Nm = 0.0;
  LoadCell cell(p, 1);
  LoadReading reading;
  for (int k = 0; k < 3; ++k) reading = cell.sample(1e-3, {2.0, 0.04});
  const double wt = 2.0 * M_PI * 150.0 * 3e-3;
  EXPECT_TRUE(near(reading.thrust_N, 2.0 * (1.0 - (1.0 + wt) * std::exp(-wt)), round_off(64, 2.0)));
  EXPECT_TRUE(near(reading.torque_Nm / reading.thrust_N, 0.02, round_off(8, 0.02)));
}

TEST(CurrentShunt, ReadsTheAverageOfPwmPulsesTimesItsGainPlusItsOffset) {
  CurrentShuntParams p;
  p.noise_A = p.noise_per_A = p.wander_A = p.warm_up_A = p.gain_tolerance = 0.0;
  p.offset_low_A = p.offset_high_A = 4.3;
  p.gain_error = 0.25;
  CurrentShunt shunt(p, 1);
  for (int k = 0; k < 400; ++k) {  // 4.4 A for 30 % of a 20 kHz period
    shunt.flow(4.4, 15e-6);
    shunt.flow(0.0, 35e-6);
  }
  // Just before a pulse the ripple is at its trough: half of 5.5 A x 0.3 x 0.7 x 50 us / 159 us below.
  EXPECT_TRUE(
      near(shunt.sample_A(), 4.3 + 1.25 * 0.3 * 4.4, stated(0.19, "ripple behind a 1 kHz pole")));
}

TEST(CurrentShunt, OffsetSettlesInAHundredSeconds) {
  double early = 0.0, late = 0.0;
  for (int seed = 1; seed <= 50; ++seed) {
    CurrentShuntParams p;
    p.noise_A = p.wander_A = 0.0;
    CurrentShunt shunt(p, seed);
    const double at_start = shunt.sample_A();
    for (int k = 0; k < 100; ++k) shunt.flow(0.0, 1.0);
    const double at_100s = shunt.sample_A();
    for (int k = 0; k < 400; ++k) shunt.flow(0.0, 1.0);
    const double settled = shunt.sample_A();
    EXPECT_GE(settled, 4.1);
    EXPECT_LE(settled, 4.6);
    early += std::abs(at_start - settled) / 50.0;
    late += std::abs(at_100s - settled) / 50.0;
  }
  EXPECT_GT(early, 0.2);
  EXPECT_TRUE(near(late / early, std::exp(-100.0 / 30.0), stated(1e-6, "exponential")));
}

TEST(CurrentShunt, NoiseGrowsWithCurrent) {
  auto spread = [](double amps) {
    CurrentShunt shunt({}, 4);
    for (int k = 0; k < 100; ++k) shunt.flow(amps, 1e-3);
    double sum = 0.0, square = 0.0;
    for (int k = 0; k < 20000; ++k) {
      const double x = shunt.sample_A();
      sum += x / 20000.0;
      square += x * x / 20000.0;
    }
    return std::sqrt(square - sum * sum);
  };
  EXPECT_TRUE(near(spread(0.0), 0.02, stated(0.001, "statistics")));
  EXPECT_TRUE(near(spread(10.0), 0.12, stated(0.005, "statistics")));
}

}  // namespace
}  // namespace whirl::plant
