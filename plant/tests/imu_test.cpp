#include "plant/sensors/imu.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "plant/tests/allan.hpp"

namespace whirl::plant {
namespace {

using Eigen::Vector3d;

ImuMotion at_rest() {
  ImuMotion m;
  m.specific_force_B_mps2 = {0.0, 0.0, -9.80665};
  return m;
}

TEST(Imu, PerfectSensorAtRestReadsMinusGravityAlongDown) {
  Imu imu({}, 1);
  const ImuSample s = imu.sample(0.001, at_rest());
  EXPECT_EQ(s.specific_force_S_mps2, Vector3d(0.0, 0.0, -9.80665));
  EXPECT_EQ(s.rate_S_radps, Vector3d::Zero());
}

// On a turntable at 10 rad/s, 5 cm out: 5 m/s^2 towards the axis; spinning up at 100 rad/s^2: 5
// m/s^2 along the rim.
TEST(Imu, LeverArmFeelsCentripetalAndRimAcceleration) {
  ImuParams params;
  params.p_BS_B_m = {0.05, 0.0, 0.0};
  Imu imu(params, 1);
  ImuMotion m;
  m.w_WB_B_radps = {0.0, 0.0, 10.0};
  m.alpha_WB_B_radps2 = {0.0, 0.0, 100.0};
  const Vector3d f = imu.sample(0.001, m).specific_force_S_mps2;
  EXPECT_TRUE(near((f - Vector3d(-5.0, 5.0, 0.0)).norm(), 0.0, round_off(8, 5.0)));
}

TEST(Imu, MisalignmentShowsGravityInTheWrongAxis) {
  ImuParams params;
  params.misalignment_rad = {0.0, 0.01, 0.0};  // sensor nose up by 0.01: x looks up
  Imu imu(params, 1);
  const Vector3d f = imu.sample(0.001, at_rest()).specific_force_S_mps2;
  EXPECT_TRUE(near(f.x(), 9.80665 * std::sin(0.01), round_off(16, 9.8)));
}

struct Still {
  std::vector<double> accel, gyro;
};

Still record(const ImuParams& params, double dt_s, int n) {
  Imu imu(params, 5);
  Still out;
  for (int k = 0; k < n; ++k) {
    const ImuSample s = imu.sample((k + 1) * dt_s, at_rest());
    out.accel.push_back(s.specific_force_S_mps2.x());
    out.gyro.push_back(s.rate_S_radps.y());
  }
  return out;
}

TEST(Imu, AllanDeviationOfTheNoiseIsItsDensityOverRootTau) {
  ImuParams params = mpu6000_physics();
  params.accelerometer.bias_instability = params.gyroscope.bias_instability = 0.0;
  const Still s = record(params, 1e-3, 1'000'000);
  for (double tau : {0.01, 0.1, 1.0}) {
    const double root = std::sqrt(tau);
    EXPECT_TRUE(
        near(allan_deviation(s.accel, 1e-3, tau) * root / 3.92e-3, 1.0, stated(0.1, "issue")));
    EXPECT_TRUE(
        near(allan_deviation(s.gyro, 1e-3, tau) * root / 8.73e-5, 1.0, stated(0.1, "issue")));
  }
}

// Whole sensor: white noise rules below, instability makes the floor of 0.664 B above.
TEST(Imu, AllanDeviationOfTheWholeSensorIsNoiseThenFloor) {
  const ImuParams params = mpu6000_physics();
  const Still s = record(params, 0.01, 2'000'000);  // five hours and a half
  for (double tau : {0.1, 1.0, 10.0, 30.0}) {
    const double accel = std::hypot(3.92e-3 / std::sqrt(tau), 0.664 * 1.0e-3);
    const double gyro = std::hypot(8.73e-5 / std::sqrt(tau), 0.664 * 1.0e-4);
    EXPECT_TRUE(near(allan_deviation(s.accel, 0.01, tau) / accel, 1.0, stated(0.1, "issue")))
        << tau;
    EXPECT_TRUE(near(allan_deviation(s.gyro, 0.01, tau) / gyro, 1.0, stated(0.1, "issue"))) << tau;
  }
}

TEST(Imu, VibrationIsAtTheRotorsFrequencyAndGrowsWithItsSquare) {
  ImuParams params;
  params.accelerometer.vibration_per_radps2 = 1e-6;
  auto amplitude = [&](double speed, double at) {
    Imu imu(params, 1);
    ImuMotion m = at_rest();
    m.rotor_speed_radps = {speed, 0.0, 0.0, 0.0};
    double c = 0.0, s = 0.0;
    const int n = 5000;
    for (int k = 1; k <= n; ++k) {
      const double x = imu.sample(k * 1e-3, m).specific_force_S_mps2.x();
      c += x * std::cos(at * k * 1e-3) * 2.0 / n;
      s += x * std::sin(at * k * 1e-3) * 2.0 / n;
    }
    return std::hypot(c, s);
  };
  EXPECT_TRUE(near(amplitude(400.0, 400.0), 0.16, stated(0.002, "5 s window")));
  EXPECT_TRUE(near(amplitude(200.0, 200.0), 0.04, stated(0.002, "5 s window")));
  EXPECT_TRUE(near(amplitude(400.0, 300.0), 0.0, stated(0.002, "5 s window")));
}

// 1 g mm of a rotor at 400 rad/s on 0.9 kg: 0.178 m/s^2 once, its shares twice and three times a turn.
TEST(Imu, UnbalanceShakesByItsForceOverTheMass) {
  ImuParams params;
  params.unbalance_second = 0.25;
  params.unbalance_blades = 0.5;
  params.blade_count = 3;
  const double once = 1e-6 * 400.0 * 400.0 / 0.9;
  auto amplitude = [&](int axis, double at, std::size_t unbalanced) {
    Imu imu(params, 1);
    ImuMotion m = at_rest();
    m.rotor_speed_radps = {400.0, 250.0};
    m.unbalance_m[unbalanced] = 1e-6 / 0.9;
    double c = 0.0, s = 0.0;
    const int n = 20000;
    for (int k = 1; k <= n; ++k) {
      const double t_s = k * 2.5e-4, x = imu.sample(t_s, m).specific_force_S_mps2[axis];
      c += x * std::cos(at * t_s) * 2.0 / n;
      s += x * std::sin(at * t_s) * 2.0 / n;
    }
    return std::hypot(c, s);
  };
  const Tolerance window = stated(0.01 * once, "5 s window");
  EXPECT_TRUE(near(amplitude(0, 400.0, 0), once, window));
  EXPECT_TRUE(near(amplitude(1, 400.0, 0), once, window));
  EXPECT_TRUE(near(amplitude(0, 800.0, 0), 0.25 * once, window));
  EXPECT_TRUE(near(amplitude(2, 1200.0, 0), 0.5 * once, window));
  EXPECT_TRUE(near(amplitude(0, 400.0, 1), 0.0, window));  // the other one shakes at its own speed
  EXPECT_TRUE(near(amplitude(0, 250.0, 1), once * 250.0 * 250.0 / 160000.0, window));
}

TEST(Imu, SameSeedSameBitsAndNamesTellSensorsApart) {
  Imu a(mpu6000_physics(), 1), b(mpu6000_physics(), 1), c(mpu6000_physics(), 2),
      d(mpu6000_physics(), 1, "imu2");
  const Vector3d want = a.sample(0.001, at_rest()).rate_S_radps;
  EXPECT_EQ(b.sample(0.001, at_rest()).rate_S_radps, want);
  EXPECT_NE(c.sample(0.001, at_rest()).rate_S_radps, want);
  EXPECT_NE(d.sample(0.001, at_rest()).rate_S_radps, want);
}

TEST(Imu, TurningOneNoiseOffLeavesTheOthersAsTheyWere) {
  ImuParams with, without;
  with.gyroscope = {.noise_density = 1e-4, .turn_on_bias = 0.02};
  with.accelerometer.noise_density = 4e-3;
  without.gyroscope = with.gyroscope;
  Imu a(with, 1), b(without, 1);
  for (int k = 1; k < 100; ++k) {
    EXPECT_EQ(a.sample(k * 1e-3, {}).rate_S_radps, b.sample(k * 1e-3, {}).rate_S_radps);
  }
}

}  // namespace
}  // namespace whirl::plant
