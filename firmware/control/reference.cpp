#include "firmware/control/reference.hpp"

#include "firmware/config/vehicle.hpp"

namespace fw {
namespace {

// Limits the horizontal part as a vector, so that its direction stays, and the vertical by itself.
Vector3 limited(Vector3 v, float horizontal, float vertical) {
  v.head<2>() = clamp_norm<2>(v.head<2>(), horizontal);
  v.z() = std::clamp(v.z(), -vertical, vertical);
  return v;
}

// Far off, brake so that the limit of acceleration suffices: v^2 = 2 a d.
float climb_limit(float error_m) {
  return std::min(config::kClimbLimit_mps,
                  std::sqrt(config::kClimbAccelerationLimit_mps2 * std::abs(error_m)));
}

}  // namespace

void Reference::start(const Vector3& p_W_m, float yaw_rad) {
  p_W_m_ = p_W_m;
  v_W_mps_.setZero();
  a_W_mps2_.setZero();
  jerk_W_mps3_.setZero();
  tracking_ = false;
  yaw_rad_ = yaw_rad;
}

void Reference::drive(const Vector3& v_wanted_W_mps, float dt_s, float most_mps2) {
  constexpr float kInner_ps = 4.0f * config::kReferenceGain_ps;
  tracking_ = false;
  jerk_W_mps3_.setZero();
  a_W_mps2_ = limited(kInner_ps * (v_wanted_W_mps - v_W_mps_), most_mps2,
                      config::kClimbAccelerationLimit_mps2);
  p_W_m_ += dt_s * v_W_mps_ + 0.5f * dt_s * dt_s * a_W_mps2_;
  v_W_mps_ += dt_s * a_W_mps2_;
}

void Reference::step(const Vector3& goal_W_m, float goal_yaw_rad, float dt_s) {
  const Vector3 error = goal_W_m - p_W_m_;
  drive(limited(config::kReferenceGain_ps * error, config::kSpeedLimit_mps, climb_limit(error.z())),
        dt_s);
  turn_to(goal_yaw_rad, dt_s);
}

void Reference::turn_to(float goal_yaw_rad, float dt_s) {
  constexpr float kYawRate_radps = 0.6f;
  const float turn = wrap_pi(goal_yaw_rad - yaw_rad_);
  yaw_rad_ = wrap_pi(yaw_rad_ + std::clamp(turn, -kYawRate_radps * dt_s, kYawRate_radps * dt_s));
}

void Reference::follow(const TrajectoryPoint& point, const Vector3& jerk_W_mps3, float age_s,
                       float dt_s) {
  tracking_ = true;
  const float half = 0.5f * age_s * age_s;
  jerk_W_mps3_ = jerk_W_mps3;
  a_W_mps2_ = point.a_W_mps2 + age_s * jerk_W_mps3;
  v_W_mps_ = point.v_W_mps + age_s * point.a_W_mps2 + half * jerk_W_mps3;
  p_W_m_ = point.p_W_m + age_s * point.v_W_mps + half * point.a_W_mps2 +
           half * age_s / 3.0f * jerk_W_mps3;
  turn_to(point.yaw_rad, dt_s);
}

void Reference::cruise(const Vector3& p_WB_W_m, const Vector3& v_wanted_W_mps, float z_m,
                       float yaw_rad, float dt_s) {
  const float error_m = z_m - p_W_m_.z();
  Vector3 wanted = v_wanted_W_mps;
  wanted.z() = config::kReferenceGain_ps * error_m;
  drive(limited(wanted, config::kSpeedLimit_mps, climb_limit(error_m)), dt_s,
        config::kCruiseAccelerationLimit_mps2);
  p_W_m_.head<2>() = p_WB_W_m.head<2>();  // nowhere to be
  turn_to(yaw_rad, dt_s);
}

void Reference::descend(const Vector3& place_W_m, float speed_mps, float dt_s) {
  Vector3 wanted = config::kReferenceGain_ps * (place_W_m - p_W_m_);
  wanted.z() = speed_mps;
  wanted.head<2>() = clamp_norm<2>(wanted.head<2>(), config::kSpeedLimit_mps);
  drive(wanted, dt_s);
}

}  // namespace fw
