#include "firmware/config/vehicle.hpp"
#include "firmware/flight/flight.hpp"
#include "firmware/flight/schedule.hpp"

namespace fw {
namespace {

using schedule::kAttitudeStep_s, schedule::kPositionStep_s;
constexpr float kLiftTime_s = 0.8f, kAirborne_m = 0.06f;
constexpr float kTargetDelay_s = 0.014f;  // 65 bytes at 57600 baud, and half a poll
// Of the four attitude steps from set-point to set-point: the one by which the steepest pieces of a step fall
// into holds such that the rotors can follow (control/attitude_reference.cpp).
constexpr unsigned kDemandTaken = 3;
constexpr std::uint16_t kIdle = 1;  // the lowest set-point that turns a rotor

}  // namespace

void Flight::position_step() {
  if (!in_air()) return;
  if (state_ != FlightState::flying) detect_touchdown();
  if (!in_air()) return;
  if (navigates()) {
    // Where it comes back may be elsewhere than where it was lost.
    if (!position_was_known_) reference_.start(estimator_.p_WB_W_m(), reference_.yaw_rad());
    // Nor does it turn about because it was turned otherwise all the time.
    if (heading_turns_ != estimator_.heading_turns()) {
      reference_.start(estimator_.p_WB_W_m(), yaw_of(estimator_.q_WB()));
    }
    heading_turns_ = estimator_.heading_turns();
    position_was_known_ = true;
    return follow_reference();
  }
  position_was_known_ = false;
  if (aim_ == Aim::attitude && state_ == FlightState::flying) return;
  wanted_ = position_control_.sink(descent_mps(), sinking_mps(), estimator_.q_WB(),
                                   reference_.yaw_rad(), lift_);
}

void Flight::follow_reference() {
  const Vector3& p_W = estimator_.p_WB_W_m();
  if (state_ == FlightState::flying) {
    lift_ = std::min(1.0f, lift_ + kPositionStep_s / kLiftTime_s);
    airborne_ = airborne_ || p_W.z() < ground_W_m_.z() - kAirborne_m;
    catch_fall();
    if (lift_ >= 1.0f) advance_reference();
    if (aim_ == Aim::attitude) return;
  } else {
    descend();
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

// Where it stands over; beyond the fence, back inside on the way.
void Flight::descend() {
  const Fence limits = fence();
  const Vector3& from = reference_.p_W_m();
  reference_.descend(limits.contains(from) ? from : limits.inside(from), descent_mps(),
                     kPositionStep_s);
}

void Flight::stay() {
  aim_ = Aim::place;
  target_W_m_ = reference_.p_W_m();
  target_yaw_rad_ = reference_.yaw_rad();
}

void Flight::advance_reference() {
  switch (aim_) {
    case Aim::place:
      return reference_.step(fence().inside(target_W_m_), target_yaw_rad_, kPositionStep_s);
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
      return reference_.cruise(
          estimator_.p_WB_W_m(),
          fence().stoppable(target_v_W_mps_, estimator_.p_WB_W_m(), config::kReferenceGain_ps),
          fence().inside(target_W_m_).z(), target_yaw_rad_, kPositionStep_s);
  }
}

// For how long it has stood still though it was asked to sink. What rocks on its feet moves up and down between
// two rests, and slowly: that takes back what a rest has given, and no more. What moves faster flies.
void Flight::count_contact() {
  constexpr float kEstablished_s = 1.2f, kStanding_mps = 0.12f, kRocking_mps = 0.3f, kMost_s = 0.5f;
  const float speed_mps = std::abs(sinking_mps());
  const bool flies =
      !(speed_mps < kRocking_mps) || state_s_ < kEstablished_s || !(descent_mps() > 0.0f);
  if (flies) {
    contact_s_ = 0.0f;
    return;
  }
  const float step_s = speed_mps < kStanding_mps ? kPositionStep_s : -kPositionStep_s;
  contact_s_ = std::clamp(contact_s_ + step_s, 0.0f, kMost_s);
}

// Asked to sink and not sinking: that is the ground. The rotors let go by and by; if it was not the
// ground, the vehicle sinks, and they take up again. From a share of 0.36 on they turn at their least, so that the
// last 0.18 s are the plainest question.
void Flight::detect_touchdown() {
  constexpr float kSure_s = 0.25f, kLetGo_s = 0.5f, kTakeUp_s = 0.3f;
  count_contact();
  if (contact_s_ > kSure_s) {
    lift_ -= kPositionStep_s / kLetGo_s;
  } else {
    lift_ = std::min(1.0f, lift_ + kPositionStep_s / kTakeUp_s);
  }
  const bool blind_too_long =
      state_ == FlightState::failsafe && !navigates() && state_s_ > blind_longest_s_;
  if (lift_ <= 0.0f || blind_too_long) {
    const bool failed = state_ == FlightState::failsafe;
    // Who flies by hand stops the motors by hand.
    const bool by_hand = steered_by_hand() && pilot_.link() == PilotLink::ok;
    if (by_hand && !failed) return enter(FlightState::armed, Reason::landed);
    stop_motors(failed ? reason_ : Reason::landed, failed);
  }
}

std::array<std::uint16_t, 4> Flight::send_setpoints() {
  rotors_.sent(setpoints_N_);
  hold_steps_ = 0;
  return setpoints_;
}

void Flight::follow_attitude() {
  if (aim_ != Aim::attitude || state_ != FlightState::flying) return;
  attitude_reference_.step(attitude_, hold_steps_ == kDemandTaken);
  attitude_reference_.put(wanted_);
  wanted_.thrust_N = collective_N(thrust_share_, position_control_.hover_thrust_N());
  wanted_.v_B_mps = wanted_.q_WB.conjugate() * estimator_.v_WB_W_mps();
}

void Flight::run_motor_to_calibrate() {
  const int motor = calibrator_.motor();
  if (motor < 0) return;
  setpoints_[static_cast<std::size_t>(motor)] = setpoint_for(MotorFieldCalibration::kThrust_N);
}

void Flight::control() {
  follow_attitude();
  ++hold_steps_;
  motors_.ask(state_ != FlightState::disarmed);
  if (!in_air()) {
    setpoints_.fill(state_ == FlightState::armed ? kIdle : 0);
    if (state_ == FlightState::armed) run_motor_to_calibrate();
    return;
  }
  if (rotors_start()) {
    rotors_.start(config::kThrustMin_N);
    return setpoints_.fill(kIdle);
  }
  right_itself();
  const bool trim = airborne_ && contact_s_ < 0.1f;
  const Vector3 tau_B = attitude_control_.torque(estimator_.q_WB(), estimator_.w_WB_B_radps(),
                                                 wanted_, kAttitudeStep_s, trim);
  // Until the next position step the wanted attitude goes on turning.
  wanted_.q_WB = turned(wanted_.q_WB, wanted_.w_B_radps, kAttitudeStep_s);
  rotors_.step(kAttitudeStep_s);
  setpoints_N_ =
      rotors_.setpoints_for(mix(wanted_.thrust_N, tau_B, rotors_.reach(), lifts_for(wanted_)));
  for (unsigned i = 0; i < 4; ++i) setpoints_[i] = setpoint_for(setpoints_N_[i]);
}

}  // namespace fw
