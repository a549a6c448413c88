// A set-point made flyable: position, velocity and acceleration that reach it without overshoot,
// within limits of speed and acceleration; or a trajectory that somebody else has made, followed
// between the points in which it is told.
#pragma once
#include "firmware/config/vehicle.hpp"
#include "firmware/math.hpp"

namespace fw {

// A point of a trajectory: valid when it was told, and to be carried on from there.
struct TrajectoryPoint {
  // Within what is flown along a trajectory: 3 m/s, 4 m/s^2.
  bool flyable() const { return v_W_mps.norm() <= 3.0f && a_W_mps2.norm() <= 4.0f; }

  Vector3 p_W_m = Vector3::Zero(), v_W_mps = Vector3::Zero(), a_W_mps2 = Vector3::Zero();
  float yaw_rad = 0.0f;
};

class Reference {
 public:
  void start(const Vector3& p_W_m, float yaw_rad);
  void step(const Vector3& goal_W_m, float goal_yaw_rad, float dt_s);
  // Along the trajectory, age_s after the point; jerk between the last two points.
  void follow(const TrajectoryPoint& point, const Vector3& jerk_W_mps3, float age_s, float dt_s);
  // A horizontal velocity, approached within the limit of acceleration, at this height.
  void cruise(const Vector3& p_WB_W_m, const Vector3& v_wanted_W_mps, float z_m, float yaw_rad,
              float dt_s);
  // Straight down from where it is, for landing.
  // Down at that speed, on the way over that place.
  void descend(const Vector3& place_W_m, float speed_mps, float dt_s);

  const Vector3& p_W_m() const { return p_W_m_; }
  const Vector3& v_W_mps() const { return v_W_mps_; }
  const Vector3& a_W_mps2() const { return a_W_mps2_; }
  const Vector3& jerk_W_mps3() const { return jerk_W_mps3_; }
  bool tracking() const { return tracking_; }
  float yaw_rad() const { return yaw_rad_; }

 private:
  void drive(const Vector3& v_wanted_W_mps, float dt_s,
             float most_mps2 = config::kAccelerationLimit_mps2);
  void turn_to(float goal_yaw_rad, float dt_s);

  Vector3 p_W_m_ = Vector3::Zero(), v_W_mps_ = Vector3::Zero(), a_W_mps2_ = Vector3::Zero();
  Vector3 jerk_W_mps3_ = Vector3::Zero();
  bool tracking_ = false;
  float yaw_rad_ = 0.0f;
};

}  // namespace fw
