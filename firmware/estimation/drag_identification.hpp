// The rotors' drag coefficient, and the wind, from a velocity over ground and the accelerometer.
//
//   Model    a_xy = c a_z (v - w)_xy in B [Bangura 2017, 4.22]. Turned into W, y = R (a_x, a_y, 0) / a_z is
//            c v - d with d = c w: linear in c and d. Zero points of the accelerometer go into d. Of y the
//            frame's drag is taken off first (drag_model.hpp)
//   Method   Kalman filter of (c, d) at 40 Hz. c is constant, d wanders a little; a residual whose mean of
//            half a second is beyond four sigmas is a change of the wind and widens d
//   Excited  c and d part only where the velocity changes: c stays as it is unless the velocity has
//            scattered by 0.15 m/s within the last seconds
//   Start    a value with the thesis's spread, 0.0035 s/m [Bangura 2017, 4.4.7], as its sigma
//   Valid    airborne, with thrust
//   Error    tests/drag_identification_test.cpp; in flight test_plans/flight/drag_identification.lua
#pragma once
#include "firmware/math.hpp"

namespace fw {

class DragIdentification {
 public:
  static constexpr float kLeast_spm = 0.02f, kMost_spm = 0.08f;

  // Forgets all but this value.
  void start(float drag_spm);
  // At 200 Hz while airborne: the specific force, the attitude, the velocity over ground.
  void add(const Vector3& a_B_mps2, const Quaternion& q_WB, const Vector3& v_WB_W_mps);
  // What was begun is too old to be gone on with: on the ground, or without a velocity.
  void pause();

  float drag_spm() const { return x_.x(); }
  float sigma_spm() const { return std::sqrt(P_(0, 0)); }
  // By flight, no longer by what it was started with.
  bool identified() const { return sigma_spm() < kIdentified * drag_spm(); }

 private:
  static constexpr float kIdentified = 0.03f;
  static constexpr int kSteps = 5;  // of 5 ms to a sample

  void update(const Eigen::Vector2f& y, const Eigen::Vector2f& v_mps);
  void update_axis(int axis, float y, float v_mps);
  void notice_wind(int axis, float residual, float variance);
  bool excited(const Eigen::Vector2f& v_mps);

  Vector3 x_ = Vector3::Zero();  // c in s/m, then d north and east
  Matrix3 P_ = Matrix3::Zero();
  Vector3 a_sum_ = Vector3::Zero(), v_sum_ = Vector3::Zero();
  int count_ = 0;
  bool running_ = false, excited_ = false;
  Eigen::Vector2f v_mean_ = Eigen::Vector2f::Zero();
  float v_variance_m2ps2_ = 0.0f;
  Eigen::Vector2f residual_ = Eigen::Vector2f::Zero();  // its mean of the last half second
};

}  // namespace fw
