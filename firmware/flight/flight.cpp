#include "firmware/flight/flight.hpp"

#include "firmware/config/vehicle.hpp"
#include "firmware/flight/schedule.hpp"

namespace fw {
namespace {

constexpr float kHighest_m = 10.0f;  // of a take-off
constexpr float kJoin_m = 0.3f;      // a trajectory is joined from so near

}  // namespace

Flight::Flight() = default;

void Flight::tick() {
  estimator_.tick();
  pilot_.tick();
  ++target_age_ms_;
  ++link_age_ms_;
  motors_.tick();
}

void Flight::on_imu(const ImuSample& sample) {
  tick();
  imu_missing_ms_ = 0;
  calibrator_.on_imu(sample.a_B_mps2, sample.w_B_radps);
  ImuSample corrected = sample;
  corrected.a_B_mps2 = correction_.acceleration(sample.a_B_mps2);
  corrected.w_B_radps = correction_.rate(sample.w_B_radps);
  estimator_.on_imu(corrected);
}

void Flight::on_imu_missing() {
  tick();
  ++imu_missing_ms_;
}

void Flight::on_fix(const CaptureFix& fix) {
  estimator_.on_fix(fix);
}

void Flight::on_battery(float voltage_V) {
  float current_A = 0.0f;
  for (const float of_motor_A : motor_currents_A()) current_A += of_motor_A;
  battery_.on_voltage(voltage_V, current_A, parameters_.get(Parameter::bat_resistance_ohm));
}

// False: it asks to land, or for nothing that can be flown to now.
bool Flight::accept_target(const Vector3& p_W_m, float yaw_rad) {
  if (steered_by_hand()) return false;
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
  const bool inside = (point.p_W_m - fence().inside(point.p_W_m)).isZero();
  if (!near || !inside) {
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
  constexpr float kSteepest_cos = 0.5f;  // 60 degrees: what tips over is not asked for
  if (steered_by_hand()) return;
  if (state_ != FlightState::flying || !airborne_ || lift_ < 1.0f) return;
  target_age_ms_ = 0;
  if (tilt_cosine(q_WB) < kSteepest_cos) return;
  if (aim_ != Aim::attitude) attitude_reference_.start(wanted_.q_WB);
  aim_ = Aim::attitude;
  attitude_ = demand_of(q_WB, yaw_rate_radps);
  thrust_share_ = thrust_share;
}

Reason Flight::arm() {
  if (!allowed(Command::arm, state_)) return Reason::wrong_state;
  if (calibrator_.running() != Calibration::none) return Reason::calibrating;
  if (state_ == FlightState::armed) return Reason::none;
  if (steered_by_hand()) return Reason::by_hand;
  if (const Reason why_not = ready_to_arm(); why_not != Reason::none) return why_not;
  begin_armed();
  return Reason::none;
}

// Here, because this file knows the mode.
bool Flight::escs_not_warm() const {
  return motors_.not_warm(esc::Mode::FW_ESC_MODE);
}

void Flight::begin_armed() {
  emergency_ = false;
  motors_.forget_failures();
  ground_W_m_ = target_W_m_ = estimator_.p_WB_W_m();  // what was flown to before is forgotten
  target_age_ms_ = kNever;
  enter(FlightState::armed, Reason::commanded);
}

Reason Flight::disarm() {
  if (!allowed(Command::disarm, state_)) return Reason::wrong_state;
  if (state_ == FlightState::armed) stop_motors(Reason::commanded, false);
  return Reason::none;
}

Reason Flight::take_off(float height_m) {
  if (!allowed(Command::take_off, state_)) return Reason::wrong_state;
  if (steered_by_hand()) return Reason::by_hand;
  if (calibrator_.running() != Calibration::none) return Reason::calibrating;
  // Who leads it by attitude leads its height, too.
  if (state_ == FlightState::flying && aim_ == Aim::attitude) return Reason::wrong_state;
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
  if (!allowed(Command::land, state_)) return Reason::wrong_state;
  if (state_ == FlightState::flying) enter(FlightState::landing, Reason::commanded);
  return Reason::none;
}

void Flight::enter(FlightState state, Reason reason) {
  if (state == FlightState::flying && state_ != FlightState::landing) {
    reference_.start(estimator_.p_WB_W_m(), yaw_of(estimator_.q_WB()));
    attitude_control_.reset();
    rotors_.start(config::kThrustMin_N);
    setpoints_N_.fill(config::kThrustMin_N);
    position_control_.reset();
    velocity_control_.reset();
    aim_ = Aim::place;
    lift_ = 0.36f;  // what the rotors carry at idle
    airborne_ = starting_ = catching_ = false;
  }
  state_ = state;
  if (!in_air()) course_lost_ = false;
  if (state_ == FlightState::failsafe) {
    constexpr float kLongestAtGround_s = 12.0f, kSlowest_mps = 0.25f;
    const float last_known_m = ground_W_m_.z() - estimator_.p_WB_W_m().z();
    blind_longest_s_ = kLongestAtGround_s + std::max(height_m(), last_known_m) / kSlowest_mps;
  }
  state_s_ = contact_s_ = 0.0f;
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
  follow_pilot();
  supervise();
  watch_calibration();
  control();
}

void Flight::apply_parameters() {
  constexpr float kDegree = kPi / 180.0f;
  if (correction_.load(parameters_)) estimator_.forget_zeros();
  estimator_.choose(parameters_.is_on(Parameter::est_filter) ? AttitudeSource::velocity_aided
                                                             : AttitudeSource::explicit_filter);
  estimator_.set_declination(kDegree * parameters_.get(Parameter::mag_declination_deg));
  estimator_.set_start(parameters_.get(Parameter::est_start_scale),
                       kDegree * parameters_.get(Parameter::est_start_tilt_deg));
  estimator_.set_drag(parameters_.get(Parameter::aero_drag_spm));
  if (state_ == FlightState::disarmed && !falling_) keep_drag();
  const float drag_spm = estimator_.drag().drag_spm();
  attitude_control_.set_drag(drag_spm);
  position_control_.set_drag(drag_spm);
  position_control_.leave_heading(parameters_.is_on(Parameter::ctl_no_heading));
  velocity_control_.set_drag(drag_spm);
}

// What flights have found becomes the parameter; less than a percent is not worth the flash.
void Flight::keep_drag() {
  const DragIdentification& drag = estimator_.drag();
  const float kept_spm = parameters_.get(Parameter::aero_drag_spm);
  if (!drag.identified() || std::abs(drag.drag_spm() - kept_spm) < 0.01f * kept_spm) return;
  parameters_.set(Parameter::aero_drag_spm, drag.drag_spm());
}

void Flight::estimate() {
  apply_parameters();
  const bool resting =
      state_ == FlightState::disarmed && !falling_ && !motors_.any_turning() && !imu_frozen_;
  const bool by_drag = state_ == FlightState::flying && aim_ == Aim::velocity;
  estimator_.step({.in_flight = in_air() || falling_,
                   .airborne = (in_air() && airborne_) || falling_,
                   .by_drag = by_drag,
                   .resting = resting});
}

void Flight::supervise() {
  state_s_ += schedule::kAttitudeStep_s;
  watch_fall();
  const bool by_attitude = steered_ == PilotMode::attitude && pilot_.link() == PilotLink::ok;
  const Conditions now = conditions();
  // Whatever its heading or the wind has become: it comes down level, and is led no further astray.
  course_lost_ |= state_ == FlightState::failsafe && now.has(Condition::off_course);
  react(supervisor_.step(now, state_, schedule::kAttitudePeriod, by_attitude));
  if (state_ == FlightState::armed && !steered_by_hand()) follow_target_into_air();
}

void Flight::react(const Decision& decision) {
  switch (decision.reaction) {
    case Reaction::none:
    case Reaction::tell:
      return;
    case Reaction::land:
      return enter(FlightState::landing, decision.reason);
    case Reaction::failsafe:
      return enter(FlightState::failsafe, decision.reason);
    case Reaction::stop:
      return stop_motors(decision.reason, false);
    case Reaction::cut:
      return cut(decision.reason);
  }
}

void Flight::follow_target_into_air() {
  const bool target_in_air = target_W_m_.z() < ground_W_m_.z() - kAboveGround_m;
  if (calibrator_.running() != Calibration::none) return;
  if (state_s_ > kSpinUp_s && target_age_ms_ < kTargetFresh_ms && target_in_air) {
    enter(FlightState::flying, Reason::commanded);
  }
}

}  // namespace fw
