#include "firmware/flight/flight.hpp"

#include "firmware/config/vehicle.hpp"

namespace fw {
namespace {

constexpr float kAttitudeStep_s = 0.005f, kPositionStep_s = 0.025f;
// On the ground the accelerometer may set roll and pitch fast; in flight it is a slow reference.
constexpr float kAccelGainGround_radps = 2.0f, kAccelGainFlight_radps = 0.2f;
constexpr float kHeadingShareGround = 1.0f, kHeadingShareFlight = 0.1f;
constexpr float kSpinUp_s = 1.5f, kLiftTime_s = 0.8f, kAirborne_m = 0.06f;
constexpr float kTipped_cos = 0.5f;       // 60 degrees
constexpr float kTiltToArm_cos = 0.985f;  // 10 degrees
constexpr float kHighest_m = 10.0f;       // of a take-off
constexpr float kAboveGround_m = 0.3f;    // a target below that does not mean flight
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
  ++fix_age_ms_;
  ++target_age_ms_;
  for (std::uint32_t& age : esc_silent_ms_) ++age;
}

void Flight::on_imu(const ImuSample& sample) {
  tick();
  imu_missing_ms_ = 0;
  sample_ = sample;
  a_sum_ += sample.a_B_mps2;
  w_sum_ += sample.w_B_radps;
  ++sum_count_;
}

void Flight::on_imu_missing() {
  tick();
  ++imu_missing_ms_;
}

void Flight::on_fix(const CaptureFix& fix) {
  const bool first = fix_age_ms_ >= kCaptureLost_ms && !in_air();
  const float since_last_s = 1e-3f * static_cast<float>(fix_age_ms_);
  fix_ = fix;
  fix_age_ms_ = 0;
  attitude_.correct_heading(fix.yaw_rad, in_air() ? kHeadingShareFlight : kHeadingShareGround);
  if (first) return position_.start(fix.p_WB_W_m);
  position_.correct(fix.p_WB_W_m, since_last_s);
  // In the air an innovation is flight; standing still it tells whether the filter has settled.
  still_fixes_ = position_.innovation_W_m().norm() < 0.03f ? still_fixes_ + 1 : 0;
}

void Flight::on_target(const Vector3& p_W_m, float yaw_rad) {
  target_age_ms_ = 0;
  const bool on_ground = p_W_m.z() > ground_W_m_.z() - kAboveGround_m;
  if (state_ == FlightState::flying) {
    if (on_ground && target_W_m_.z() <= ground_W_m_.z() - kAboveGround_m && airborne_) {
      return enter(FlightState::landing, Reason::commanded);
    }
    if (on_ground) return;
  }
  target_W_m_ = p_W_m;
  target_yaw_rad_ = yaw_rad;
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
  if (fix_age_ms_ > kCaptureFresh_ms) return Reason::no_capture;
  if (!calibrated_) return Reason::imu_not_calibrated;
  if (still_fixes_ < kSettled) return Reason::estimate_not_converged;
  if (tilt_cosine(attitude_.q_WB()) < kTiltToArm_cos) return Reason::tilted;
  return first_esc_problem();
}

Reason Flight::arm() {
  if (state_ == FlightState::armed) return Reason::none;
  if (state_ != FlightState::disarmed) return Reason::wrong_state;
  if (const Reason why_not = ready_to_arm(); why_not != Reason::none) return why_not;
  emergency_ = false;
  ground_W_m_ = position_.p_WB_W_m();
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
    target_yaw_rad_ = yaw_of(attitude_.q_WB());
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
    reference_.start(position_.p_WB_W_m(), yaw_of(attitude_.q_WB()));
    attitude_control_.reset();
    position_control_.reset();
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
  calibration_.restart();
}

void Flight::attitude_step() {
  estimate();
  if (state_ == FlightState::disarmed) calibrate_on_ground();
  supervise();
  control();
}

void Flight::estimate() {
  if (sum_count_ > 0) {
    const float scale = 1.0f / static_cast<float>(sum_count_);
    a_B_mps2_ = scale * a_sum_ - accel_bias_B_mps2_;
    const Vector3 w_B = scale * w_sum_;
    a_sum_.setZero();
    w_sum_.setZero();
    sum_count_ = 0;
    if (!started_) attitude_.start(a_B_mps2_, fix_.yaw_rad);
    started_ = true;
    const float gain =
        state_ == FlightState::disarmed ? kAccelGainGround_radps : kAccelGainFlight_radps;
    attitude_.update(w_B, a_B_mps2_, kAttitudeStep_s, gain);
  }
  position_.predict(attitude_.q_WB(), a_B_mps2_, kAttitudeStep_s);
}

void Flight::calibrate_on_ground() {
  const bool turning = std::any_of(
      esc_status_.begin(), esc_status_.end(),
      [](const esc::protocol::Status& s) { return (s.flags & esc::flag_turning) != 0; });
  if (turning || imu_frozen_ || fix_age_ms_ > kCaptureFresh_ms) return calibration_.restart();
  const Quaternion q_WB = from_euler(fix_.roll_rad, fix_.pitch_rad, fix_.yaw_rad);
  const Vector3 raw_w = attitude_.w_WB_B_radps() + attitude_.gyro_bias_B_radps();
  if (!calibration_.add(raw_w, a_B_mps2_ + accel_bias_B_mps2_, q_WB)) return;
  attitude_.set_gyro_bias(calibration_.gyro_bias_B_radps());
  accel_bias_B_mps2_ = calibration_.accel_bias_B_mps2();
  if (!calibrated_) {
    attitude_.start(q_WB.conjugate() * Vector3(0.0f, 0.0f, -config::kGravity_mps2), fix_.yaw_rad);
    position_.start(fix_.p_WB_W_m);
  }
  calibrated_ = true;
}

void Flight::supervise() {
  state_s_ += kAttitudeStep_s;
  if (state_ == FlightState::disarmed) return;
  if (imu_missing_ms_ > kImuLost_ms) return stop_motors(Reason::imu_not_running, true);
  if (imu_frozen_) return stop_motors(Reason::imu_frozen, true);
  tipped_s_ = tilt_cosine(attitude_.q_WB()) < kTipped_cos ? tipped_s_ + kAttitudeStep_s : 0.0f;
  if (tipped_s_ > 0.1f) return stop_motors(Reason::tipped_over, true);
  watch_flight();
}

// What ends a flight, or begins it: from here on the vehicle can still be controlled.
void Flight::watch_flight() {
  const bool capture_lost = fix_age_ms_ > kCaptureLost_ms;
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
  if (state_ == FlightState::armed && state_s_ > kSpinUp_s && target_age_ms_ < kCaptureLost_ms &&
      target_in_air) {
    enter(FlightState::flying, Reason::commanded);
  }
}

void Flight::position_step() {
  if (!in_air()) return;
  if (state_ != FlightState::flying) detect_touchdown();
  if (!in_air()) return;
  if (capture_fresh()) return follow_reference();
  wanted_ = position_control_.sink(config::kDescent_mps, position_.v_WB_W_mps(), attitude_.q_WB(),
                                   reference_.yaw_rad(), lift_);
  // If the capture comes back, go on from where it finds us.
  reference_.start(position_.p_WB_W_m(), reference_.yaw_rad());
}

void Flight::follow_reference() {
  const Vector3& p_W = position_.p_WB_W_m();
  if (state_ == FlightState::flying) {
    lift_ = std::min(1.0f, lift_ + kPositionStep_s / kLiftTime_s);
    airborne_ = airborne_ || p_W.z() < ground_W_m_.z() - kAirborne_m;
    if (lift_ >= 1.0f) reference_.step(target_W_m_, target_yaw_rad_, kPositionStep_s);
  } else {
    const bool near = p_W.z() > ground_W_m_.z() - config::kTouchdownHeight_m;
    reference_.descend(near ? config::kTouchdown_mps : config::kDescent_mps, kPositionStep_s);
  }
  const bool integrate = lift_ >= 1.0f && contact_s_ < 0.1f;
  wanted_ = position_control_.step(p_W, position_.v_WB_W_mps(), attitude_.q_WB(), reference_, lift_,
                                   kPositionStep_s, integrate);
}

// Asked to sink and not sinking: that is the ground. The rotors let go by and by; if it was not the
// ground, the vehicle sinks, and they take up again.
void Flight::detect_touchdown() {
  constexpr float kEstablished_s = 1.2f, kStanding_mps = 0.12f, kSure_s = 0.25f;
  constexpr float kLetGo_s = 0.5f, kTakeUp_s = 0.3f, kLongest_s = 12.0f;
  const bool standing = std::abs(position_.v_WB_W_mps().z()) < kStanding_mps;
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

void Flight::control() {
  if (!in_air()) return setpoints_.fill(state_ == FlightState::armed ? kIdle : 0);
  const bool trim = airborne_ && contact_s_ < 0.1f;
  const Vector3 tau_B = attitude_control_.torque(attitude_.q_WB(), attitude_.w_WB_B_radps(),
                                                 wanted_.q_WB, kAttitudeStep_s, trim);
  const RotorThrusts thrusts = mix(wanted_.thrust_N, tau_B);
  for (unsigned i = 0; i < 4; ++i) setpoints_[i] = setpoint_for(thrusts[i]);
}

}  // namespace fw
