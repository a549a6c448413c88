#include "firmware/flight/flight.hpp"

#include "firmware/config/vehicle.hpp"

namespace fw {
namespace {

constexpr float kAttitudeStep_s = 0.005f, kPositionStep_s = 0.025f;
constexpr float kSpinUp_s = 1.5f, kLiftTime_s = 0.8f, kAirborne_m = 0.06f;
constexpr float kTipped_cos = 0.5f;       // 60 degrees
constexpr float kTiltToArm_cos = 0.985f;  // 10 degrees
constexpr float kHighest_m = 10.0f;       // of a take-off
constexpr float kAboveGround_m = 0.3f;    // a target below that does not mean flight
constexpr float kJoin_m = 0.3f;           // a trajectory is joined from so near
constexpr float kTargetDelay_s = 0.014f;  // 65 bytes at 57600 baud, and half a poll
constexpr std::uint16_t kIdle = 1;        // the lowest set-point that turns a rotor

}  // namespace

const char* text_of(Reason reason) {
  switch (reason) {
    case Reason::none:
      return "ready";
    case Reason::imu_not_running:
      return "IMU gives no samples";
    case Reason::imu_frozen:
      return "IMU samples are frozen";
    case Reason::imu_not_calibrated:
      return "IMU not calibrated yet";
    case Reason::no_capture:
      return "no motion capture";
    case Reason::estimate_not_converged:
      return "estimate not converged";
    case Reason::tilted:
      return "not level";
    case Reason::esc_not_armed:
      return "an ESC is not armed";
    case Reason::esc_fault:
      return "an ESC reports a fault";
    case Reason::esc_silent:
      return "an ESC is silent";
    case Reason::no_setpoints:
      return "set-points stopped";
    case Reason::tipped_over:
      return "tipped over";
    case Reason::landed:
      return "landed";
    case Reason::commanded:
      return "commanded";
    case Reason::wrong_state:
      return "not in this state";
    case Reason::height_out_of_range:
      return "height out of range";
  }
  return "";
}

void Flight::tick() {
  estimator_.tick();
  pilot_.tick();
  ++target_age_ms_;
  for (std::uint32_t& age : esc_silent_ms_) ++age;
}

void Flight::on_imu(const ImuSample& sample) {
  tick();
  imu_missing_ms_ = 0;
  estimator_.on_imu(sample);
}

void Flight::on_imu_missing() {
  tick();
  ++imu_missing_ms_;
}

void Flight::on_fix(const CaptureFix& fix) {
  estimator_.on_fix(fix);
}

// False: it asks to land, or for nothing that can be flown to now.
bool Flight::accept_target(const Vector3& p_W_m, float yaw_rad) {
  target_age_ms_ = 0;
  const bool on_ground = p_W_m.z() > ground_W_m_.z() - kAboveGround_m;
  if (state_ == FlightState::flying) {
    if (on_ground && target_W_m_.z() <= ground_W_m_.z() - kAboveGround_m && airborne_) {
      enter(FlightState::landing, Reason::commanded);
      return false;
    }
    if (on_ground) return false;
  }
  target_W_m_ = p_W_m;
  target_yaw_rad_ = yaw_rad;
  return true;
}

void Flight::on_target(const Vector3& p_W_m, float yaw_rad) {
  if (accept_target(p_W_m, yaw_rad)) aim_ = Aim::place;
}

void Flight::on_trajectory(const TrajectoryPoint& told) {
  if (!told.flyable()) return;
  TrajectoryPoint point = told;
  if (!parameters_.is_on(Parameter::ctl_feedforward)) point.a_W_mps2.setZero();
  const float since_last_s = 1e-3f * static_cast<float>(target_age_ms_);
  const bool goes_on = aim_ == Aim::trajectory && target_age_ms_ < kTargetFresh_ms;
  if (!accept_target(point.p_W_m, point.yaw_rad)) return;
  const bool near = (point.p_W_m - reference_.p_W_m()).norm() < kJoin_m;
  if (!near) {
    aim_ = Aim::place;
    return;
  }
  // Two points that came together are no time apart.
  constexpr float kMostJerk_mps3 = 5.0f;
  jerk_W_mps3_.setZero();
  if (goes_on && since_last_s > 0.02f) {
    jerk_W_mps3_ = clamp_norm<3>((point.a_W_mps2 - point_.a_W_mps2) / since_last_s, kMostJerk_mps3);
  }
  point_ = point;
  aim_ = Aim::trajectory;
}

void Flight::on_velocity(const Vector3& v_W_mps, float z_m, float yaw_rad) {
  const Vector3& p_W = estimator_.p_WB_W_m();
  if (!accept_target({p_W.x(), p_W.y(), z_m}, yaw_rad)) return;
  target_v_W_mps_ = {v_W_mps.x(), v_W_mps.y(), 0.0f};
  if (aim_ != Aim::velocity) velocity_control_.reset();
  aim_ = Aim::velocity;
}

void Flight::on_attitude(const Quaternion& q_WB, float yaw_rate_radps, float thrust_share) {
  target_age_ms_ = 0;
  if (state_ != FlightState::flying || !airborne_ || lift_ < 1.0f) return;
  if (tilt_cosine(q_WB) < kTipped_cos) return;
  if (aim_ != Aim::attitude) attitude_reference_.start(wanted_.q_WB);
  aim_ = Aim::attitude;
  attitude_ = demand_of(q_WB, yaw_rate_radps);
  thrust_share_ = thrust_share;
}

Reason Flight::first_esc_problem() const {
  for (unsigned i = 0; i < 4; ++i) {
    const std::uint8_t flags = esc_status_[i].flags;
    if (esc_silent_ms_[i] > kEscSilent_ms) return Reason::esc_silent;
    if ((flags & (esc::flag_over_current | esc::flag_under_voltage | esc::flag_desync)) != 0) {
      return Reason::esc_fault;
    }
    if ((flags & esc::flag_armed) == 0) return Reason::esc_not_armed;
  }
  return Reason::none;
}

Reason Flight::ready_to_arm() const {
  constexpr std::uint32_t kSettled = 20;  // fixes in a row, half a second
  if (imu_missing_ms_ > kImuLost_ms) return Reason::imu_not_running;
  if (imu_frozen_) return Reason::imu_frozen;
  if (estimator_.fix_age_ms() > Estimator::kFixFresh_ms) return Reason::no_capture;
  if (!estimator_.calibrated()) return Reason::imu_not_calibrated;
  if (estimator_.still_fixes() < kSettled) return Reason::estimate_not_converged;
  if (tilt_cosine(estimator_.q_WB()) < kTiltToArm_cos) return Reason::tilted;
  return first_esc_problem();
}

Reason Flight::arm() {
  if (state_ == FlightState::armed) return Reason::none;
  if (state_ != FlightState::disarmed) return Reason::wrong_state;
  if (const Reason why_not = ready_to_arm(); why_not != Reason::none) return why_not;
  emergency_ = false;
  ground_W_m_ = estimator_.p_WB_W_m();
  enter(FlightState::armed, Reason::commanded);
  return Reason::none;
}

Reason Flight::disarm() {
  if (in_air()) return Reason::wrong_state;
  if (state_ == FlightState::armed) stop_motors(Reason::commanded, false);
  return Reason::none;
}

Reason Flight::take_off(float height_m) {
  if (state_ != FlightState::armed && state_ != FlightState::flying) return Reason::wrong_state;
  if (!(height_m > kAboveGround_m && height_m < kHighest_m)) return Reason::height_out_of_range;
  if (state_ == FlightState::armed) {
    target_W_m_ = ground_W_m_;
    target_yaw_rad_ = yaw_of(estimator_.q_WB());
    enter(FlightState::flying, Reason::commanded);
  }
  target_W_m_.z() = -height_m;
  return Reason::none;
}

Reason Flight::land() {
  if (state_ != FlightState::flying) return Reason::wrong_state;
  enter(FlightState::landing, Reason::commanded);
  return Reason::none;
}

void Flight::enter(FlightState state, Reason reason) {
  if (state == FlightState::flying) {
    reference_.start(estimator_.p_WB_W_m(), yaw_of(estimator_.q_WB()));
    attitude_control_.reset();
    rotors_.start(config::kThrustMin_N);
    setpoints_N_.fill(config::kThrustMin_N);
    position_control_.reset();
    velocity_control_.reset();
    aim_ = Aim::place;
    lift_ = 0.36f;  // what the rotors carry at idle
    airborne_ = false;
  }
  state_ = state;
  state_s_ = contact_s_ = tipped_s_ = 0.0f;
  reason_ = reason;
  ++reason_count_;
}

void Flight::stop_motors(Reason reason, bool emergency) {
  enter(FlightState::disarmed, reason);
  emergency_ = emergency;
  airborne_ = false;
  setpoints_.fill(0);
}

void Flight::attitude_step() {
  estimate();
  supervise();
  control();
}

void Flight::apply_parameters() {
  constexpr float kDegree = kPi / 180.0f;
  estimator_.choose(parameters_.is_on(Parameter::est_filter) ? AttitudeSource::velocity_aided
                                                             : AttitudeSource::explicit_filter);
  estimator_.set_declination(kDegree * parameters_.get(Parameter::mag_declination_deg));
  estimator_.set_start(parameters_.get(Parameter::est_start_scale),
                       kDegree * parameters_.get(Parameter::est_start_tilt_deg));
}

void Flight::estimate() {
  apply_parameters();
  const bool turning = std::any_of(
      esc_status_.begin(), esc_status_.end(),
      [](const esc::protocol::Status& s) { return (s.flags & esc::flag_turning) != 0; });
  const bool resting = state_ == FlightState::disarmed && !turning && !imu_frozen_;
  estimator_.step({.in_flight = in_air(), .airborne = in_air() && airborne_, .resting = resting});
}

void Flight::supervise() {
  state_s_ += kAttitudeStep_s;
  if (state_ == FlightState::disarmed) return;
  if (imu_missing_ms_ > kImuLost_ms) return stop_motors(Reason::imu_not_running, true);
  if (imu_frozen_) return stop_motors(Reason::imu_frozen, true);
  tipped_s_ = tilt_cosine(estimator_.q_WB()) < kTipped_cos ? tipped_s_ + kAttitudeStep_s : 0.0f;
  if (tipped_s_ > 0.1f) return stop_motors(Reason::tipped_over, true);
  watch_flight();
}

// What ends a flight, or begins it: from here on the vehicle can still be controlled.
void Flight::watch_flight() {
  const bool capture_lost = !capture_fresh();
  const bool esc_silent =
      *std::max_element(esc_silent_ms_.begin(), esc_silent_ms_.end()) > kEscSilent_ms;
  if (state_ == FlightState::failsafe) return;
  if (capture_lost || esc_silent) {
    const Reason reason = capture_lost ? Reason::no_capture : Reason::esc_silent;
    if (state_ == FlightState::armed) return stop_motors(reason, false);
    return enter(FlightState::failsafe, reason);
  }
  if (state_ == FlightState::flying && target_age_ms_ > kTargetsLost_ms &&
      target_age_ms_ < kNever) {
    return enter(FlightState::landing, Reason::no_setpoints);
  }
  const bool target_in_air = target_W_m_.z() < ground_W_m_.z() - kAboveGround_m;
  if (state_ == FlightState::armed && state_s_ > kSpinUp_s && target_age_ms_ < kTargetFresh_ms &&
      target_in_air) {
    enter(FlightState::flying, Reason::commanded);
  }
}

void Flight::position_step() {
  if (!in_air()) return;
  if (state_ != FlightState::flying) detect_touchdown();
  if (!in_air()) return;
  if (capture_fresh()) return follow_reference();
  wanted_ = position_control_.sink(config::kDescent_mps, estimator_.v_WB_W_mps(), estimator_.q_WB(),
                                   reference_.yaw_rad(), lift_);
  // If the capture comes back, go on from where it finds us.
  reference_.start(estimator_.p_WB_W_m(), reference_.yaw_rad());
}

void Flight::follow_reference() {
  const Vector3& p_W = estimator_.p_WB_W_m();
  if (state_ == FlightState::flying) {
    lift_ = std::min(1.0f, lift_ + kPositionStep_s / kLiftTime_s);
    airborne_ = airborne_ || p_W.z() < ground_W_m_.z() - kAirborne_m;
    if (lift_ >= 1.0f) advance_reference();
    if (aim_ == Aim::attitude) return;
  } else {
    const bool near = p_W.z() > ground_W_m_.z() - config::kTouchdownHeight_m;
    reference_.descend(near ? config::kTouchdown_mps : config::kDescent_mps, kPositionStep_s);
  }
  const bool integrate = lift_ >= 1.0f && contact_s_ < 0.1f;
  const Vector3& v_W = estimator_.v_WB_W_mps();
  if (aim_ == Aim::velocity && state_ == FlightState::flying && lift_ >= 1.0f) {
    const float f =
        position_control_.height_force(p_W, v_W, reference_, lift_, kPositionStep_s, integrate);
    wanted_ = velocity_control_.step(v_W, estimator_.q_WB(), reference_, f, kPositionStep_s);
    return;
  }
  wanted_ = position_control_.step(p_W, estimator_.v_WB_W_mps(), estimator_.q_WB(), reference_,
                                   lift_, kPositionStep_s, integrate);
}

void Flight::stay() {
  aim_ = Aim::place;
  target_W_m_ = reference_.p_W_m();
  target_yaw_rad_ = reference_.yaw_rad();
}

void Flight::advance_reference() {
  switch (aim_) {
    case Aim::place:
      return reference_.step(target_W_m_, target_yaw_rad_, kPositionStep_s);
    case Aim::trajectory:
      if (target_age_ms_ > kTargetFresh_ms) {  // nobody leads any more
        stay();
        return reference_.step(target_W_m_, target_yaw_rad_, kPositionStep_s);
      }
      return reference_.follow(point_, jerk_W_mps3_,
                               kTargetDelay_s + 1e-3f * static_cast<float>(target_age_ms_),
                               kPositionStep_s);
    case Aim::attitude:
      reference_.start(estimator_.p_WB_W_m(), attitude_reference_.yaw_rad());
      if (target_age_ms_ > kTargetFresh_ms) stay();
      return;
    case Aim::velocity:
      return reference_.cruise(estimator_.p_WB_W_m(), target_v_W_mps_, target_W_m_.z(),
                               target_yaw_rad_, kPositionStep_s);
  }
}

// Asked to sink and not sinking: that is the ground. The rotors let go by and by; if it was not the
// ground, the vehicle sinks, and they take up again.
void Flight::detect_touchdown() {
  constexpr float kEstablished_s = 1.2f, kStanding_mps = 0.12f, kSure_s = 0.25f;
  constexpr float kLetGo_s = 0.5f, kTakeUp_s = 0.3f, kLongest_s = 12.0f;
  const bool standing = std::abs(estimator_.v_WB_W_mps().z()) < kStanding_mps;
  const bool counts = standing && state_s_ > kEstablished_s;
  contact_s_ = counts ? contact_s_ + kPositionStep_s : 0.0f;
  if (contact_s_ > kSure_s) {
    lift_ -= kPositionStep_s / kLetGo_s;
  } else {
    lift_ = std::min(1.0f, lift_ + kPositionStep_s / kTakeUp_s);
  }
  const bool blind_too_long = state_ == FlightState::failsafe && state_s_ > kLongest_s;
  if (lift_ < 0.2f || blind_too_long) {
    const bool failed = state_ == FlightState::failsafe;
    stop_motors(failed ? reason_ : Reason::landed, failed);
  }
}

std::array<std::uint16_t, 4> Flight::send_setpoints() {
  rotors_.sent(setpoints_N_);
  return setpoints_;
}

void Flight::follow_attitude() {
  if (aim_ != Aim::attitude || state_ != FlightState::flying) return;
  attitude_reference_.step(attitude_);
  attitude_reference_.put(wanted_);
  wanted_.thrust_N = collective_N(thrust_share_, position_control_.hover_thrust_N());
  wanted_.v_B_mps = wanted_.q_WB.conjugate() * estimator_.v_WB_W_mps();
}

void Flight::control() {
  follow_attitude();
  if (!in_air()) return setpoints_.fill(state_ == FlightState::armed ? kIdle : 0);
  const bool trim = airborne_ && contact_s_ < 0.1f;
  const Vector3 tau_B = attitude_control_.torque(estimator_.q_WB(), estimator_.w_WB_B_radps(),
                                                 wanted_, kAttitudeStep_s, trim);
  // Until the next position step the wanted attitude goes on turning.
  wanted_.q_WB = turned(wanted_.q_WB, wanted_.w_B_radps, kAttitudeStep_s);
  rotors_.step(kAttitudeStep_s);
  setpoints_N_ = rotors_.setpoints_for(mix(wanted_.thrust_N, tau_B, rotors_.reach()));
  for (unsigned i = 0; i < 4; ++i) setpoints_[i] = setpoint_for(setpoints_N_[i]);
}

}  // namespace fw
