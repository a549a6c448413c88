// A set-point made flyable: position, velocity and acceleration that reach it without overshoot,
// within limits of speed and acceleration.
#pragma once
#include "firmware/math.hpp"

namespace fw {

class Reference {
 public:
  void start(const Vector3& p_W_m, float yaw_rad);
  void step(const Vector3& goal_W_m, float goal_yaw_rad, float dt_s);
  // Straight down from where it is, for landing.
  void descend(float speed_mps, float dt_s);

  const Vector3& p_W_m() const { return p_W_m_; }
  const Vector3& v_W_mps() const { return v_W_mps_; }
  const Vector3& a_W_mps2() const { return a_W_mps2_; }
  float yaw_rad() const { return yaw_rad_; }

 private:
  void drive(const Vector3& v_wanted_W_mps, float dt_s);

  Vector3 p_W_m_ = Vector3::Zero(), v_W_mps_ = Vector3::Zero(), a_W_mps2_ = Vector3::Zero();
  float yaw_rad_ = 0.0f;
};

}  // namespace fw
