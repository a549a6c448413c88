#include "firmware/calibration/sensor_correction.hpp"

namespace fw {
namespace {

std::size_t row(Parameter first, int further) {
  return static_cast<std::size_t>(first) + static_cast<std::size_t>(further);
}

Vector3 triple(const Parameters& parameters, Parameter first, int motor = 0) {
  const int at = 3 * motor;
  return {parameters.value(row(first, at)), parameters.value(row(first, at + 1)),
          parameters.value(row(first, at + 2))};
}

void keep(Parameters& parameters, Parameter first, const Vector3& v, int motor = 0) {
  for (int i = 0; i < 3; ++i) parameters.set(row(first, 3 * motor + i), v[i], false);
}

}  // namespace

bool SensorCorrection::load(const Parameters& parameters) {
  if (loaded_ && changes_ == parameters.changes()) return false;
  loaded_ = true;
  changes_ = parameters.changes();
  const Vector3 gyro = triple(parameters, Parameter::cal_gyro_x_radps);
  const Vector3 accel = triple(parameters, Parameter::cal_accel_x_mps2);
  const Vector3 scale = triple(parameters, Parameter::cal_accel_scale_x);
  const bool inertial = gyro != gyro_ || accel != accel_ || scale != scale_;
  gyro_ = gyro;
  accel_ = accel;
  scale_ = scale;
  centre_ = triple(parameters, Parameter::cal_mag_x_uT);
  const Vector3 along = triple(parameters, Parameter::cal_mag_scale_x);
  const Vector3 across = triple(parameters, Parameter::cal_mag_xy);  // xy, xz, yz
  W_ << along.x(), across.x(), across.y(),                           //
      across.x(), along.y(), across.z(),                             //
      across.y(), across.z(), along.z();
  for (std::size_t i = 0; i < k_uTpA_.size(); ++i) {
    k_uTpA_[i] = triple(parameters, Parameter::cal_motor_1x_uTpA, static_cast<int>(i));
  }
  return inertial;
}

Vector3 SensorCorrection::field(const Vector3& m_B_uT, const MotorCurrents& current_A) const {
  Vector3 m = m_B_uT - centre_;
  for (std::size_t i = 0; i < k_uTpA_.size(); ++i) m -= current_A[i] * k_uTpA_[i];
  return W_ * m;
}

void keep_gyro(Parameters& parameters, const Vector3& offset_B_radps) {
  keep(parameters, Parameter::cal_gyro_x_radps, offset_B_radps);
}

void keep_accelerometer(Parameters& parameters, const Vector3& offset_B_mps2,
                        const Vector3& scale) {
  keep(parameters, Parameter::cal_accel_x_mps2, offset_B_mps2);
  keep(parameters, Parameter::cal_accel_scale_x, scale);
}

void keep_magnetometer(Parameters& parameters, const Vector3& centre_B_uT, const Matrix3& W) {
  keep(parameters, Parameter::cal_mag_x_uT, centre_B_uT);
  keep(parameters, Parameter::cal_mag_scale_x, W.diagonal());
  keep(parameters, Parameter::cal_mag_xy, {W(0, 1), W(0, 2), W(1, 2)});
}

void keep_motor_fields(Parameters& parameters, const std::array<Vector3, 4>& k_B_uTpA) {
  for (std::size_t i = 0; i < k_B_uTpA.size(); ++i) {
    keep(parameters, Parameter::cal_motor_1x_uTpA, k_B_uTpA[i], static_cast<int>(i));
  }
}

}  // namespace fw
