#include "firmware/estimation/ground_calibration.hpp"

#include "firmware/config/vehicle.hpp"

namespace fw {

bool GroundCalibration::add(const Vector3& w_B_radps, const Vector3& a_B_mps2,
                            const Quaternion& q_WB) {
  const bool moved = (w_B_radps - w_first_).cwiseAbs().maxCoeff() > kStillRate_radps ||
                     (a_B_mps2 - a_first_).cwiseAbs().maxCoeff() > kStillAcceleration_mps2;
  if (count_ == 0 || moved) {
    count_ = 0;
    w_first_ = w_B_radps;
    a_first_ = a_B_mps2;
    w_sum_.setZero();
    a_sum_.setZero();
    ideal_sum_.setZero();
  }
  w_sum_ += w_B_radps;
  a_sum_ += a_B_mps2;
  ideal_sum_ += q_WB.conjugate() * Vector3(0.0f, 0.0f, -config::kGravity_mps2);
  if (++count_ < kWindow) return false;
  const float scale = 1.0f / static_cast<float>(kWindow);
  gyro_bias_ = scale * w_sum_;
  accel_bias_ = scale * (a_sum_ - ideal_sum_);
  count_ = 0;
  return true;
}

}  // namespace fw
