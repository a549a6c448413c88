// Motors stopped in the air, by command or because nothing could be controlled; and started again there.
#include "firmware/config/vehicle.hpp"
#include "firmware/flight/flight.hpp"
#include "firmware/flight/restart.hpp"
#include "firmware/flight/schedule.hpp"

namespace fw {
namespace {

constexpr float kCaught_mps = 1.0f, kLongestCatch_s = 4.0f;

}  // namespace

// Off wherever it is.
void Flight::cut(Reason reason) {
  const bool falls = in_air() && airborne_;
  if (reason == Reason::motor_out) motors_.keep_failed();
  stop_motors(reason, true);
  falling_ = falls;
  fall_drag_.start();
  attitude_lost_ = false;
  quiet_s_ = 0.0f;
}

Reason Flight::kill() {
  if (in_air()) {
    cut(Reason::killed);
    return Reason::none;
  }
  return disarm();
}

Reason Flight::restart() {
  if (!falling_) return arm();
  if (steered_by_hand()) return Reason::by_hand;
  const Vector3 up_W = estimator_.q_WB() * Vector3::UnitZ();
  const Fall fall{
      .attitude_known = !attitude_lost_,
      .speed_known = estimator_.position_known() || estimator_.pressure_good(),
      .height_m = height_m(),
      .sinking_mps = sinking_mps(),
      .tilt_rad = std::atan2(up_W.head<2>().norm(), up_W.z()),
      .drag_pm = fall_drag_.least_pm(),
      .rotors_failed = motors_.failed(),
      .esc_problem = first_esc_problem(),
  };
  if (const Reason why_not = why_not_restart(fall); why_not != Reason::none) return why_not;
  falling_ = emergency_ = false;
  motors_.forget_failures();
  enter(FlightState::flying, Reason::restarted);
  lift_ = 1.0f;
  airborne_ = starting_ = catching_ = righting_ = true;
  target_age_ms_ = kNever;  // what was flown to before is forgotten
  stay();
  return Reason::none;
}

// While it falls: whether the attitude is still known, and whether it has come to rest. Without any speed
// nothing tells a steady fall from rest but the time that no fall lasts.
void Flight::watch_fall() {
  constexpr float kRest_mps2 = 1.5f, kRest_radps = 0.3f, kRest_mps = 0.5f;
  constexpr float kRest_s = 1.0f, kNoFall_s = 20.0f;
  if (!falling_) return;
  const Conditions now = conditions();
  attitude_lost_ =
      attitude_lost_ || now.has(Condition::imu_not_running) || now.has(Condition::imu_frozen);
  const bool speed_known = estimator_.position_known() || estimator_.pressure_good();
  const Vector3& felt_B_mps2 = estimator_.imu().a_B_mps2;
  fall_drag_.step(-(estimator_.q_WB() * felt_B_mps2).z(), sinking_mps(), schedule::kAttitudeStep_s);
  const float off_mps2 = felt_B_mps2.norm() - config::kGravity_mps2;
  const bool quiet = std::abs(off_mps2) < kRest_mps2 &&
                     estimator_.w_WB_B_radps().norm() < kRest_radps &&
                     (!speed_known || std::abs(sinking_mps()) < kRest_mps);
  quiet_s_ = quiet ? quiet_s_ + schedule::kAttitudeStep_s : 0.0f;
  if (quiet_s_ > (speed_known ? kRest_s : kNoFall_s)) falling_ = false;
}

// All at once: one that carries before the others tips the vehicle over.
bool Flight::rotors_start() {
  constexpr float kStatusSince_s = 0.1f;  // an older word of an ESC may be of before
  if (!starting_) return false;
  starting_ =
      state_ == FlightState::flying && !(state_s_ > kStatusSince_s && motors_.all_turning());
  return starting_;
}

// The fall is braked where it is; the place to hold is where it has ended.
void Flight::catch_fall() {
  if (!catching_) return;
  reference_.start(estimator_.p_WB_W_m(), reference_.yaw_rad());
  stay();
  catching_ =
      state_s_ < kLongestCatch_s && (starting_ || estimator_.v_WB_W_mps().norm() > kCaught_mps);
}

// Far from level the rotors turn it upright first, and at a rate that a set-point each 20 ms can end:
// 0.4 rad ahead ask for 3.6 rad/s. At the least thrust, which a fall on its side asks for, they could not. Once it is
// level it may lean as it brakes what threw it aside: the two would fight, and throw it over.
void Flight::right_itself() {
  constexpr float kLevel_cos = 0.88f, kOver_cos = 0.5f, kAhead_rad = 0.4f;  // 28 and 60 degrees
  constexpr float kThrust_N = 2.0f * (config::kThrustMin_N + config::kThrustUsable_N);
  const Quaternion& q_WB = estimator_.q_WB();
  const float level = tilt_cosine(q_WB);
  if (level > kLevel_cos) righting_ = false;
  if (level < kOver_cos) righting_ = true;
  if (!catching_ || !righting_) return;
  const Vector3 across_W = (q_WB * Vector3::UnitZ()).cross(Vector3::UnitZ());
  const float sine = across_W.norm();
  const Vector3 axis_W = sine > 0.01f ? Vector3(across_W / sine) : Vector3(q_WB * Vector3::UnitX());
  const float half = 0.5f * std::min(kAhead_rad, std::atan2(sine, level));
  const Vector3 turn = std::sin(half) * axis_W;
  wanted_ = {
      .thrust_N = kThrust_N,
      .q_WB = (Quaternion(std::cos(half), turn.x(), turn.y(), turn.z()) * q_WB).normalized()};
}

}  // namespace fw
