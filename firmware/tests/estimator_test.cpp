// What the estimator is for, fact by fact: told of a motion that is made here, what does it know of it?
// Noise has no part in these. The motion is level, so that Newton's laws for it are two lines.
#include "firmware/estimation/estimator.hpp"

#include <gtest/gtest.h>

#include <deque>

#include "base/near.hpp"
#include "firmware/tests/gps_model.hpp"

namespace fw::test {
namespace {

using Eigen::Vector3d;
using whirl::near, whirl::stated;

constexpr double kG = 9.80665;
constexpr Situation kAirborne{.in_flight = true, .airborne = true, .resting = false};

// A vehicle that stays level, whatever pushes it, and its sensors: IMU 1 kHz, barometer and magnetometer
// 77 Hz, capture 40 Hz and 10 ms late, GPS 5 Hz and 110 ms late.
struct Bench {
  void run(double seconds) {
    for (long i = std::lround(1000 * seconds); i > 0; --i) step();
  }
  void step() {
    p_W += 1e-3 * v_W + 0.5e-6 * a_W;
    v_W += 1e-3 * a_W;
    path.push_front({p_W, v_W});
    if (path.size() > 200) path.pop_back();
    estimator.tick();
    const Eigen::Quaterniond q_WB(Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()));
    const Vector3d felt_B = q_WB.conjugate() * (a_W - Vector3d(0, 0, kG));
    estimator.on_imu(
        {.a_B_mps2 = (felt_B + accel_zero).cast<float>(), .w_B_radps = gyro_zero.cast<float>()});
    if (ms % 13 == 0 && pressure) {
      const double height_m = 600.0 - p_W.z() + baro_error_m;  // standard atmosphere
      estimator.on_pressure(
          static_cast<float>(101325.0 * std::pow(1.0 - height_m / 44330.8, 5.25588)));
    }
    if (ms % 13 == 5 && field) {
      estimator.on_field((q_WB.conjugate() * Vector3d(23.0, 0.0, 53.0)).cast<float>());
    }
    if (ms % 25 == 0 && capture) {
      // Cameras' last digit is never still, either.
      const Vector3d seen_W = ago(10).p_W + Vector3d(0, 0, 1e-4 * (ms / 25 % 2));
      estimator.on_fix({.p_WB_W_m = seen_W.cast<float>(), .yaw_rad = float(yaw_rad)});
    }
    if (ms % 200 == 0 && gps) {
      GpsSolution solution = solution_at(ago(110).p_W, ago(110).v_W);
      solution.height_mm += ms / 200 % 2;  // a receiver's last digit is never still
      estimator.on_gps(solution);
    }
    if (ms % 5 == 4) estimator.step(situation);
    ++ms;
  }
  struct Moment {
    Vector3d p_W, v_W;
  };
  Moment ago(std::size_t ms_ago) const { return path[std::min(ms_ago, path.size() - 1)]; }

  Estimator estimator;
  Situation situation;
  Vector3d p_W{0, 0, 0}, v_W{0, 0, 0}, a_W{0, 0, 0}, gyro_zero{0, 0, 0}, accel_zero{0, 0, 0};
  double yaw_rad = 0.0, baro_error_m = 0.0;
  bool capture = false, gps = false, field = true, pressure = true;
  std::deque<Moment> path;
  int ms = 0;
};

double heading_error(const Quaternion& q_WB, double yaw_rad) {
  return wrap_pi(yaw_of(q_WB) - static_cast<float>(yaw_rad));
}

double tilt_rad(const Quaternion& q_WB) {
  return std::acos(std::min(1.0, static_cast<double>(tilt_cosine(q_WB))));
}

// A gyro that is 0.02 rad/s off, as it was seen to be on the ground, turns nothing by 0.2 rad in 10 s.
TEST(Estimator, AZeroPointOfTheGyroThatWasSeenAtRestTurnsNoHeadingInTheAir) {
  Bench bench;
  bench.gyro_zero = {0.03, -0.02, 0.02};
  bench.capture = true;
  bench.run(3.0);
  ASSERT_TRUE(bench.estimator.calibrated());
  bench.situation = kAirborne;
  bench.capture = bench.field = false;
  bench.run(10.0);
  const auto& e = bench.estimator;
  for (const Quaternion& q_WB :
       {e.explicit_filter().q_WB(), e.body().q_WB(), e.inertial().q_WB()}) {
    EXPECT_TRUE(near(heading_error(q_WB, 0.0), 0.0, stated(0.01, "5 % of what it would be")));
    EXPECT_LT(tilt_rad(q_WB), 0.01);
  }
  EXPECT_LT(e.w_WB_B_radps().norm(), 0.001f);
}

// An accelerometer that is 0.3 m/s2 off reads as drag of 0.77 m/s (0.04 s/m of 9.8 m/s2), and as a tilt of 1.8
// degrees. It was seen at rest, with the capture's attitude: neither may be left.
TEST(Estimator, AZeroPointOfTheAccelerometerThatWasSeenAtRestIsNoWindAndNoTilt) {
  Bench bench;
  bench.accel_zero = {0.3, -0.25, 0.4};
  bench.capture = true;
  bench.run(3.0);
  ASSERT_TRUE(bench.estimator.calibrated());
  bench.situation = kAirborne;
  bench.capture = false;
  bench.run(10.0);
  const auto& e = bench.estimator;
  EXPECT_LT(e.body().v_AB_B_mps().norm(), 0.05f);
  EXPECT_LT(tilt_rad(e.explicit_filter().q_WB()), 0.002);
  EXPECT_LT(tilt_rad(e.body().q_WB()), 0.002);
}

void expect_heading_in_both(const Estimator& estimator, double yaw_rad) {
  for (const Quaternion& q_WB : {estimator.body().q_WB(), estimator.inertial().q_WB()}) {
    EXPECT_TRUE(
        near(heading_error(q_WB, yaw_rad), 0.0, stated(0.05 * yaw_rad, "5 % of what it was off")));
  }
}

// Filter 1 knows of the capture's heading by filter 2 alone. Both began 0.4 rad off; no field.
TEST(Estimator, Filter1HasTheCapturesHeadingFromFilter2) {
  Bench bench;
  bench.capture = true;
  bench.field = false;
  bench.run(3.0);
  bench.situation = kAirborne;
  bench.yaw_rad = 0.4;
  bench.run(15.0);
  expect_heading_in_both(bench.estimator, 0.4);
}

// Outdoors filter 2 knows of the field's heading by filter 1 alone, which it holds back on the way: by 0.5 /s
// towards the field, 0.5 /s and 0.1 /s towards each other, the slower way of both is 21 s.
TEST(Estimator, Filter2HasTheFieldsHeadingFromFilter1) {
  Bench bench;
  bench.gps = true;
  bench.run(12.0);
  bench.situation = kAirborne;
  bench.yaw_rad = 0.4;
  bench.run(100.0);
  ASSERT_TRUE(bench.estimator.position_known());
  expect_heading_in_both(bench.estimator, 0.4);
}

// The weather moves the barometer's height by 3 m, and the receiver's draws it back in 600 s: after 150 s
// e^(-1/4) of it is left.
TEST(Estimator, TheReceiversHeightDrawsTheBarometersBackInTenMinutes) {
  Bench bench;
  bench.gps = true;
  bench.run(12.0);
  bench.situation = kAirborne;
  for (int i = 0; i < 30; ++i) {
    bench.baro_error_m += 0.1;
    bench.run(0.2);
  }
  bench.run(5.0);
  const double before_m = bench.estimator.baro_z_m();
  ASSERT_TRUE(near(before_m, -3.0, stated(0.15, "11 s of the 600, and the filter's settling")));
  bench.run(150.0);
  ASSERT_TRUE(bench.estimator.position_known());
  EXPECT_TRUE(near(bench.estimator.baro_z_m(), std::exp(-0.25) * before_m,
                   stated(0.06, "2 %: the end of the filter's settling")));
}

// At 5 m/s a solution that is taken for one of now, not of 110 ms ago, is a place 55 cm behind.
TEST(Estimator, ALateSolutionLeavesAVehicleOnItsWayNoDistanceBehind) {
  Bench bench;
  bench.gps = true;
  bench.run(12.0);
  bench.situation = kAirborne;
  bench.a_W = {0.3, 0.4, 0.0};
  bench.run(10.0);
  bench.a_W.setZero();
  bench.run(40.0);
  ASSERT_TRUE(bench.estimator.position_known());
  const Vector3d error_m = bench.estimator.p_WB_W_m().cast<double>() - bench.p_W;
  EXPECT_LT(error_m.head<2>().norm(),
            0.08);  // 1.2 cm of latitude, 2 cm of float, 16 ms of 5 m/s in all
  EXPECT_LT((bench.estimator.v_WB_W_mps().cast<double>() - bench.v_W).head<2>().norm(), 0.05);
}

// The radio brings a fix 10 ms late: 44 bytes of ten bits at 57600 baud take 7.6 ms, and a poll of 5 ms half of
// that. At 3 m/s a filter that takes it for one of now is 3 cm behind.
TEST(Estimator, ALateFixLeavesAVehicleOnItsWayNoDistanceBehind) {
  Bench bench;
  bench.capture = true;
  bench.run(3.0);
  bench.situation = kAirborne;
  bench.a_W = {0.3, -0.4, 0.0};
  bench.run(6.0);
  bench.a_W.setZero();
  bench.run(20.0);
  const Vector3d error_m = bench.estimator.p_WB_W_m().cast<double>() - bench.p_W;
  EXPECT_LT(error_m.norm(), 0.01);
}

}  // namespace
}  // namespace fw::test
