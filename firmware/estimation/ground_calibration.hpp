// Zero points of the IMU while the vehicle stands still: means over one second, thrown away when
// anything moved meanwhile.
//
//   Gyro    the mean is its bias
//   Accel   the mean minus what an ideal one reads in the attitudes that the capture system reports
#pragma once
#include "firmware/math.hpp"

namespace fw {

class GroundCalibration {
 public:
  // q_WB: from the capture system. True: a window is complete and still; take the results.
  bool add(const Vector3& w_B_radps, const Vector3& a_B_mps2, const Quaternion& q_WB);
  void restart() { count_ = 0; }

  const Vector3& gyro_bias_B_radps() const { return gyro_bias_; }
  const Vector3& accel_bias_B_mps2() const { return accel_bias_; }

 private:
  static constexpr int kWindow = 200;  // at 200 Hz
  static constexpr float kStillRate_radps = 0.03f, kStillAcceleration_mps2 = 0.5f;

  int count_ = 0;
  Vector3 w_first_, a_first_, w_sum_, a_sum_, ideal_sum_;
  Vector3 gyro_bias_ = Vector3::Zero(), accel_bias_ = Vector3::Zero();
};

}  // namespace fw
