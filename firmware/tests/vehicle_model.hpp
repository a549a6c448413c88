// A small rigid-body quadrotor to close the loop around Flight: written from Newton and Euler, shares
// no line and no constant with what it tests.
//
//   Frame    W north-east-down, B forward-right-down, both at the centre of mass; SI, double
//   Rotors   thrust follows its set-point with a first-order lag of 25 ms and a gain error
//   Sensors  IMU at 1 kHz with white noise, bias and a 2 ms delay; capture at 40 Hz, 10 ms late,
//            with losses; barometer and magnetometer at 100 Hz, perfect; the battery's voltage
//   Ground   four stiff damped feet with friction, at the arms' ends, 0.1 m below the centre
//   Left out blade aerodynamics, battery, vibration: the stand has those
#pragma once
#include <Eigen/Dense>
#include <array>
#include <deque>
#include <random>

#include "firmware/flight/flight.hpp"
#include "firmware/flight/schedule.hpp"

namespace fw::test {

struct Scenario {
  double thrust_gain = 1.0;  // true thrust over asked thrust
  Eigen::Vector3d gyro_bias_radps{0.05, -0.03, 0.02};
  Eigen::Vector3d accel_bias_mps2{0.3, -0.25, 0.4};
  double capture_loss = 0.05;
  unsigned seed = 1;
};

class VehicleModel {
 public:
  static constexpr double kFoot_m = 0.1;

  explicit VehicleModel(const Scenario& scenario) : scenario_(scenario), random_(scenario.seed) {}

  // One millisecond: physics, sensors, and the tasks that are due.
  void step(Flight& flight);
  void run(Flight& flight, double seconds) {
    for (long i = std::lround(seconds * 1000.0); i > 0; --i) step(flight);
  }

  Eigen::Vector3d p_W_{0, 0, -kFoot_m}, v_W_{0, 0, 0}, w_B_{0, 0, 0}, wind_W_{0, 0, 0};
  Eigen::Vector3d push_W_N_{0, 0, 0};  // at the centre of mass, beside what else there is
  Eigen::Quaterniond q_WB_{1, 0, 0, 0};
  bool capture_on_ = true, capture_stuck_ = false, imu_on_ = true, pressure_on_ = true,
       field_on_ = true;
  // What these read beside the truth: a magnet that the body carries, another pressure, another frame.
  Eigen::Vector3d field_error_B_uT_{0, 0, 0}, capture_error_m_{0, 0, 0};
  double pressure_error_Pa_ = 0.0, capture_turn_rad_ = 0.0;
  double battery_V_ = 16.4;
  std::array<bool, 4> esc_on_{true, true, true, true};
  double tilt_rad() const { return std::acos((q_WB_ * Eigen::Vector3d::UnitZ()).z()); }
  double time_s() const { return 1e-3 * ms_; }
  std::array<double, 4> thrust_N_{};

 private:
  void physics(double dt_s);
  void sense(Flight& flight);
  void slow_sensors(Flight& flight);
  void escs(Flight& flight);
  Eigen::Vector3d noise(double sigma) {
    std::normal_distribution<double> normal(0.0, sigma);
    const double x = normal(random_), y = normal(random_), z = normal(random_);
    return {x, y, z};
  }

  struct Fix {
    int due_ms;
    CaptureFix fix;
  };
  Scenario scenario_;
  std::mt19937 random_;
  Eigen::Vector3d f_B_{0, 0, -9.81};
  std::array<double, 4> asked_N_{};
  std::array<int, 4> zeros_{};
  std::array<bool, 4> armed_{};
  std::deque<ImuSample> imu_line_;
  std::deque<Fix> fix_line_;
  CaptureFix newest_;
  int ms_ = 0;
};

inline void VehicleModel::physics(double dt_s) {
  constexpr double m = 0.9, g = 9.81, arm = 0.25, torque_per_thrust = 0.0175, lag_s = 0.025;
  const Eigen::Vector3d inertia(0.0125, 0.0125, 0.0235);
  for (unsigned i = 0; i < 4; ++i) {
    const double target = esc_on_[i] ? scenario_.thrust_gain * asked_N_[i] : 0.0;
    thrust_N_[i] += dt_s / lag_s * (target - thrust_N_[i]);
  }
  const auto& T = thrust_N_;
  const double total = T[0] + T[1] + T[2] + T[3];
  Eigen::Vector3d tau(arm * (T[3] - T[1]), arm * (T[0] - T[2]),
                      torque_per_thrust * (T[0] - T[1] + T[2] - T[3]));
  Eigen::Vector3d air_B = q_WB_.conjugate() * (v_W_ - wind_W_);
  Eigen::Vector3d force_B(-0.04 * total * air_B.x(), -0.04 * total * air_B.y(), -total);
  Eigen::Vector3d force_W = q_WB_ * force_B + push_W_N_;
  const Eigen::Vector3d feet[4] = {
      {arm, 0, kFoot_m}, {0, arm, kFoot_m}, {-arm, 0, kFoot_m}, {0, -arm, kFoot_m}};
  for (const Eigen::Vector3d& foot_B : feet) {
    const Eigen::Vector3d r_W = q_WB_ * foot_B;
    const double depth = p_W_.z() + r_W.z();
    if (depth <= 0.0) continue;
    const Eigen::Vector3d v_foot = v_W_ + q_WB_ * w_B_.cross(foot_B);
    const double normal = std::max(0.0, 1500.0 * depth + 40.0 * v_foot.z());
    const Eigen::Vector3d f(-5.0 * v_foot.x(), -5.0 * v_foot.y(), -normal);
    force_W += f;
    tau += q_WB_.conjugate() * r_W.cross(f);
  }
  f_B_ = q_WB_.conjugate() * force_W / m;
  v_W_ += dt_s * (force_W / m + Eigen::Vector3d(0, 0, g));
  p_W_ += dt_s * v_W_;
  const Eigen::Vector3d momentum = inertia.cwiseProduct(w_B_);
  w_B_ += dt_s * (tau - w_B_.cross(momentum)).cwiseQuotient(inertia);
  const Eigen::Vector3d half = 0.5 * dt_s * w_B_;
  q_WB_ = (q_WB_ * Eigen::Quaterniond(1.0, half.x(), half.y(), half.z())).normalized();
}

inline void VehicleModel::sense(Flight& flight) {
  ImuSample sample;
  sample.a_B_mps2 = (f_B_ + scenario_.accel_bias_mps2 + noise(0.05)).cast<float>();
  sample.w_B_radps = (w_B_ + scenario_.gyro_bias_radps + noise(0.0012)).cast<float>();
  imu_line_.push_back(sample);
  if (imu_line_.size() > 2) imu_line_.pop_front();
  if (imu_on_) flight.on_imu(imu_line_.front());
  if (!imu_on_) flight.on_imu_missing();
  if (ms_ % 10 == 9) slow_sensors(flight);
  std::uniform_real_distribution<double> luck(0.0, 1.0);
  if (ms_ % 25 == 7 && luck(random_) > scenario_.capture_loss && capture_on_) {
    const Eigen::AngleAxisd turn(capture_turn_rad_, Eigen::Vector3d::UnitZ());
    const Eigen::Matrix3d R = (turn * q_WB_).toRotationMatrix();
    const Eigen::Vector3d p = p_W_ + noise(0.0005) + capture_error_m_;
    const CaptureFix seen{p.cast<float>(), static_cast<float>(std::atan2(R(2, 1), R(2, 2))),
                          static_cast<float>(-std::asin(R(2, 0))),
                          static_cast<float>(std::atan2(R(1, 0), R(0, 0)))};
    if (!capture_stuck_) newest_ = seen;
    fix_line_.push_back({ms_ + 10, newest_});
  }
  if (!fix_line_.empty() && fix_line_.front().due_ms <= ms_) {
    flight.on_fix(fix_line_.front().fix);
    fix_line_.pop_front();
  }
}

inline void VehicleModel::slow_sensors(Flight& flight) {
  constexpr double declination = 12.4 * M_PI / 180.0;
  const Eigen::Vector3d field_W(23.0 * std::cos(declination), 23.0 * std::sin(declination), -53.0);
  const Eigen::Vector3d field_B = q_WB_.conjugate() * field_W + field_error_B_uT_;
  // Standard atmosphere, 600 m above the sea.
  const double pressure_Pa = 101325.0 * std::pow(1.0 - 2.25577e-5 * (600.0 - p_W_.z()), 5.25588);
  if (pressure_on_) flight.on_pressure(static_cast<float>(pressure_Pa + pressure_error_Pa_));
  if (field_on_) flight.on_field(field_B.cast<float>());
  flight.on_battery(static_cast<float>(battery_V_));
}

inline void VehicleModel::escs(Flight& flight) {
  const std::array<std::uint16_t, 4> v = flight.send_setpoints();
  for (unsigned i = 0; i < 4; ++i) {
    if (!esc_on_[i]) continue;
    zeros_[i] = v[i] == 0 ? zeros_[i] + 1 : 0;
    armed_[i] = armed_[i] || zeros_[i] >= 25;
    asked_N_[i] = v[i] == 0 || !armed_[i] ? 0.0 : 0.8 + (v[i] - 1) / 2046.0 * 7.2;
    flight.on_esc_answered(i);
    const std::uint8_t flags = (armed_[i] ? 1 : 0) | (thrust_N_[i] > 0.3 ? 2 : 0);
    flight.on_esc_status(i, {500, 4000, flags});
  }
}

inline void VehicleModel::step(Flight& flight) {
  for (int i = 0; i < 4; ++i) physics(0.00025);
  sense(flight);
  const auto tick = static_cast<std::uint32_t>(ms_);
  if (schedule::attitude(tick)) flight.attitude_step();
  if (schedule::setpoints(tick)) escs(flight);
  if (schedule::position(tick)) flight.position_step();
  ++ms_;
}

}  // namespace fw::test
