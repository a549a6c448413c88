// Filter 1: velocity through the air, along the body's axes, and attitude from it.
//
//   Frame    V in B against the air; q_WB as in math.hpp; scale u of the rotation X = u R
//   Source   [Bangura 2017, Theorem 6.1, (6.2) to (6.4)], at 200 Hz:
//            V' = -(W - bW) x V + g X'e3 + a - ba - D1v - kvc D1vc,  D1v = kv (V - Vm)
//            R' = R [W - bW]x - kr [D1r]x R - D1rc R,                D1r = (g/u) R V~ x e3
//            u' = -ku g V~'R'e3,  bW' = kb R'D1r,  ba' = kba D1v - kbac (ba - ba2)
//   Vm       x, y by the rotors' drag: a = c a_z V [4.22]; z by the height filter. On the ground 0
//   Gains    tilt: s^3 + kv s^2 + kr g^2 s + kb g^2, scale: s^2 + kv s + ku g^2; both settle in 5 s
//   Differs  heading as an angle about W's third axis, of (6.3c)'s measure but normalised, and turning
//            the estimate towards the field (as printed it turns away); bW' rotated into B; no bias
//            along z, where the scale says the same
#pragma once
#include "firmware/math.hpp"

namespace fw {

// What filter 2 knows, and filter 1 is drawn to. Without a velocity over ground there is none.
struct FromInertialFilter {
  bool valid = false;
  Quaternion q_WB = Quaternion::Identity();
  Vector3 v_through_air_W_mps = Vector3::Zero();  // v2 - w
  Vector3 accel_bias_B_mps2 = Vector3::Zero();
};

class BodyFilter {
 public:
  void start(const Quaternion& q_WB, float scale);
  // w, a: what gyro and accelerometer show, without the zero points found on the ground.
  void step(const Vector3& w_B_radps, const Vector3& a_B_mps2, const Vector3& v_measured_B_mps,
            const FromInertialFilter& other, float dt_s);
  // The magnetic field, and the declination of the place: towards east of north.
  void correct_heading(const Vector3& field_B, float declination_rad, float since_last_s);

  void turn(const Quaternion& by_W) { q_WB_ = by_W * q_WB_; }

  const Quaternion& q_WB() const { return q_WB_; }
  const Vector3& v_AB_B_mps() const { return v_B_mps_; }
  float scale() const { return scale_; }
  bool finite() const {
    return std::isfinite(q_WB_.coeffs().sum() + v_B_mps_.sum() + scale_ + gyro_bias_B_radps_.sum() +
                         accel_bias_B_mps2_.sum());
  }
  const Vector3& gyro_bias_B_radps() const { return gyro_bias_B_radps_; }
  const Vector3& accel_bias_B_mps2() const { return accel_bias_B_mps2_; }

 private:
  Quaternion q_WB_ = Quaternion::Identity();
  Vector3 v_B_mps_ = Vector3::Zero();
  float scale_ = 1.0f;
  Vector3 gyro_bias_B_radps_ = Vector3::Zero(), accel_bias_B_mps2_ = Vector3::Zero();
};

}  // namespace fw
