// Filter 2: velocity over ground, along W's axes, attitude from it, and the wind.
//
//   Source   [Bangura 2017, Theorem 6.2, (6.5) to (6.8)]. Between fixes, at 200 Hz:
//            v' = R (a - ba) + u g e3 - kvc ((v - w) - R1 V1),  R' = R [W - bW]x - D2rc R
//            w' = -kw ((w - v) + R1 V1)
//            and with each fix, times the time since the last:
//            v by D2v = kv (v - vm), R by kr D2r, D2r = (g/u) v~ x e3, u by ku g v~'e3,
//            bW by kb R'D2r, ba by kba R'D2v
//   Fixes    are late: each is compared with the velocity that the filter had then
//   Differs  gravity is scaled by u as in (6.2a), or u would change nothing (6.5a, c); the biases'
//            innovations are turned into B (6.5e, f); the heading of a camera room (6.8) as an angle
#pragma once
#include <array>

#include "firmware/math.hpp"

namespace fw {

struct FromBodyFilter {
  Quaternion q_WB = Quaternion::Identity();
  Vector3 v_AB_W_mps = Vector3::Zero();  // R1 V1
  Vector3 accel_bias_B_mps2 = Vector3::Zero();
  bool hold_wind = false;  // without fixes v2 is no reference for the wind: it stays
};

class InertialFilter {
 public:
  static constexpr float kLongestDelay_s = 0.3f;

  void start(const Quaternion& q_WB, const Vector3& v_W_mps, float scale);
  // After a gap in the fixes, from what filter 1 has kept. Biases and scale stay.
  void resume(const Quaternion& q_WB, const Vector3& v_W_mps);
  void predict(const Vector3& w_B_radps, const Vector3& a_B_mps2, const FromBodyFilter& other,
               float dt_s);
  // A velocity as it was delay_s ago, since_last_s after the one before.
  void correct(const Vector3& v_WB_W_mps, float delay_s, float since_last_s);
  void correct_heading(float yaw_rad, float since_last_s);

  void turn(const Quaternion& by_W) { q_WB_ = by_W * q_WB_; }

  const Quaternion& q_WB() const { return q_WB_; }
  const Vector3& v_WB_W_mps() const { return v_W_mps_; }
  const Vector3& wind_W_mps() const { return wind_W_mps_; }
  float scale() const { return scale_; }
  bool finite() const {
    return std::isfinite(q_WB_.coeffs().sum() + v_W_mps_.sum() + wind_W_mps_.sum() + scale_ +
                         gyro_bias_B_radps_.sum() + accel_bias_B_mps2_.sum());
  }
  const Vector3& accel_bias_B_mps2() const { return accel_bias_B_mps2_; }

 private:
  static constexpr unsigned kHistory = 64;  // steps of 5 ms
  const Vector3& v_ago(float delay_s) const;

  Quaternion q_WB_ = Quaternion::Identity();
  Vector3 v_W_mps_ = Vector3::Zero(), wind_W_mps_ = Vector3::Zero();
  float scale_ = 1.0f;
  Vector3 gyro_bias_B_radps_ = Vector3::Zero(), accel_bias_B_mps2_ = Vector3::Zero();
  std::array<Vector3, kHistory> history_{};
  unsigned newest_ = 0;
};

}  // namespace fw
