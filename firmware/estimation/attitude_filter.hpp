// Explicit complementary filter on the quaternion: gyro for the fast part, the accelerometer's
// direction for roll and pitch, the motion-capture yaw for heading.
//
//   Source  [Bangura 2017, appendix C, after Mahony 2008]: w_mes = sum k v x v^,
//           q' = 1/2 q p(W - b + kP w_mes), b' = -kI w_mes, with v^ = R^T e3
//   Valid   the accelerometer speaks of down only near 1 g: outside 0.8 to 1.2 g it is left out
//   Left out  the vehicle's own acceleration; at these gains a second of 1 m/s^2 costs 2 degrees
#pragma once
#include "firmware/math.hpp"

namespace fw {

class AttitudeFilter {
 public:
  // Level start: roll and pitch from the specific force, heading as given.
  void start(const Vector3& a_B_mps2, float yaw_rad);
  void update(const Vector3& w_B_radps, const Vector3& a_B_mps2, float dt_s,
              float accel_gain_radps);
  // One fix of the heading, `share` of its error at once.
  void correct_heading(float yaw_rad, float share);
  void set_gyro_bias(const Vector3& bias_B_radps) { bias_B_radps_ = bias_B_radps; }

  void turn(const Quaternion& by_W) { q_WB_ = by_W * q_WB_; }

  const Quaternion& q_WB() const { return q_WB_; }
  const Vector3& w_WB_B_radps() const { return w_B_radps_; }  // bias taken off
  const Vector3& gyro_bias_B_radps() const { return bias_B_radps_; }

 private:
  Quaternion q_WB_ = Quaternion::Identity();
  Vector3 w_B_radps_ = Vector3::Zero();
  Vector3 bias_B_radps_ = Vector3::Zero();
};

}  // namespace fw
