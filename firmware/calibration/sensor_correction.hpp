// From what the inertial sensor and the magnetometer read to what is meant: the one place where the parameters
// CAL_... act.
//
//   Accelerometer  s (a - o), axis by axis      Gyro  w - o
//   Magnetometer   W (m - c - sum_i k_i I_i), with what the ESCs tell of their currents
//   Frame    B; parameters in the order of their rows, along x, y, z
#pragma once
#include "firmware/calibration/motor_field_calibration.hpp"
#include "firmware/config/parameters.hpp"
#include "firmware/math.hpp"

namespace fw {

class SensorCorrection {
 public:
  // True: the inertial sensor's have changed.
  bool load(const Parameters& parameters);

  Vector3 acceleration(const Vector3& a_B_mps2) const {
    return scale_.cwiseProduct(a_B_mps2 - accel_);
  }
  Vector3 rate(const Vector3& w_B_radps) const { return w_B_radps - gyro_; }
  Vector3 field(const Vector3& m_B_uT, const MotorCurrents& current_A) const;

 private:
  std::uint32_t changes_ = 0;
  bool loaded_ = false;
  Vector3 gyro_ = Vector3::Zero(), accel_ = Vector3::Zero(), scale_ = Vector3::Ones();
  Vector3 centre_ = Vector3::Zero();
  Matrix3 W_ = Matrix3::Identity();
  std::array<Vector3, 4> k_uTpA_{Vector3::Zero(), Vector3::Zero(), Vector3::Zero(),
                                 Vector3::Zero()};
};

// What a calibration has found becomes parameters.
void keep_gyro(Parameters& parameters, const Vector3& offset_B_radps);
void keep_accelerometer(Parameters& parameters, const Vector3& offset_B_mps2, const Vector3& scale);
void keep_magnetometer(Parameters& parameters, const Vector3& centre_B_uT, const Matrix3& W);
void keep_motor_fields(Parameters& parameters, const std::array<Vector3, 4>& k_B_uTpA);

}  // namespace fw
