// Position and velocity between and through the motion-capture fixes.
//
//   Model   velocity from the accelerometer turned into W; position from velocity; the accelerometer's
//           error in W (tilt, bias) as a slow state. Fixes correct all three: a Luenberger observer
//           with a triple pole
//   Fixes   are late (capture, radio): each is compared with where the filter was kFixDelay_s ago
//   Source  p' = v - k(p - p_meas) [Bangura 2017, 6.3]; gains from the pole
#pragma once
#include "firmware/math.hpp"

namespace fw {

class PositionFilter {
 public:
  void start(const Vector3& p_WB_W_m);
  void predict(const Quaternion& q_WB, const Vector3& a_B_mps2, float dt_s);
  void correct(const Vector3& p_WB_W_m, float since_last_fix_s);
  void hold_still();  // standing on the ground: the velocity is zero

  const Vector3& p_WB_W_m() const { return p_W_m_; }
  const Vector3& v_WB_W_mps() const { return v_W_mps_; }
  const Vector3& innovation_W_m() const { return innovation_W_m_; }

 private:
  static constexpr float kFixDelay_s = 0.010f;  // 44 bytes at 57600 baud, and half a poll

  Vector3 p_W_m_ = Vector3::Zero(), v_W_mps_ = Vector3::Zero(), bias_W_mps2_ = Vector3::Zero();
  Vector3 innovation_W_m_ = Vector3::Zero();
};

}  // namespace fw
