// Flown by hand: what the sticks ask for becomes attitudes and velocities, the arm switch arms.
#include "firmware/config/vehicle.hpp"
#include "firmware/flight/flight.hpp"
#include "firmware/flight/manual.hpp"
#include "firmware/flight/schedule.hpp"

namespace fw {
void Flight::follow_pilot() {
  if (pilot_.link() != PilotLink::ok) {
    arm_switch_ = true;  // it has to be seen off before it arms
    return;
  }
  const PilotDemand& sticks = pilot_.demand();
  if (sticks.mode != steered_) hand_over(sticks.mode);
  follow_arm_switch(sticks);
  if (steered_ == PilotMode::autonomous) return;
  const bool lifts = manual::lifts(sticks);
  if (state_ == FlightState::armed && sticks.arm && lifts && state_s_ > kSpinUp_s) {
    enter(FlightState::flying, Reason::commanded);
    hand_over(steered_);
  } else if (state_ == FlightState::landing && lifts && reason_ == Reason::commanded) {
    enter(FlightState::flying, Reason::commanded);
    hand_over(steered_);
  }
  if (state_ == FlightState::flying) follow_sticks(sticks);
}

void Flight::follow_arm_switch(const PilotDemand& sticks) {
  const bool switched_on = sticks.arm && !arm_switch_;
  const bool by_hand = steered_ != PilotMode::autonomous;
  const bool switched_off = !sticks.arm && (arm_switch_ || by_hand);
  arm_switch_ = sticks.arm;
  if (switched_on && state_ == FlightState::disarmed) {
    const Reason why_not = sticks.throttle_low() ? ready_to_arm() : Reason::throttle_high;
    if (why_not != Reason::none) return refuse(why_not);
    begin_armed();
  }
  // Who armed by radio while the switch was off is not stopped by it: it has to be switched.
  if (switched_off && sticks.throttle_low() && state_ == FlightState::armed) {
    stop_motors(Reason::commanded, false);
  }
}

// From here on somebody else steers, from where the vehicle is.
void Flight::hand_over(PilotMode mode) {
  steered_ = mode;
  target_age_ms_ = kNever;  // who steers next has said nothing yet
  if (state_ != FlightState::flying) return;
  // While it lifts off the reference stays on the ground.
  const bool from_attitude = aim_ == Aim::attitude;
  if (from_attitude) reference_.start(estimator_.p_WB_W_m(), attitude_reference_.yaw_rad());
  stay();
  if (mode == PilotMode::velocity) {
    velocity_control_.reset();
    target_v_W_mps_.setZero();
    aim_ = Aim::velocity;
  } else if (mode == PilotMode::attitude) {
    attitude_reference_.start(airborne_ ? wanted_.q_WB : estimator_.q_WB());
    aim_ = Aim::attitude;
  }
}

void Flight::follow_sticks(const PilotDemand& sticks) {
  target_age_ms_ = 0;
  if (steered_ == PilotMode::attitude) {
    attitude_ = manual::attitude_of(sticks);
    thrust_share_ = sticks.throttle;
    const bool down = sticks.throttle_low() && height_m() < manual::kGround_m &&
                      std::abs(sinking_mps()) < manual::kStanding_mps;
    contact_s_ = down ? contact_s_ + schedule::kAttitudeStep_s : 0.0f;
    if (contact_s_ > manual::kSettled_s) enter(FlightState::armed, Reason::landed);
    return;
  }
  const manual::VelocityDemand wanted = manual::velocity_of(sticks, reference_.yaw_rad());
  target_v_W_mps_ = wanted.v_W_mps;
  if (wanted.climb_mps != 0.0f) {
    target_W_m_.z() = reference_.p_W_m().z() - wanted.climb_mps / config::kReferenceGain_ps;
  }
  if (wanted.yaw_rate_radps != 0.0f) {
    target_yaw_rad_ = wrap_pi(reference_.yaw_rad() + manual::kYawLead_s * wanted.yaw_rate_radps);
  }
  const bool down = wanted.climb_mps < 0.0f && airborne_ && height_m() < config::kTouchdownHeight_m;
  if (down) enter(FlightState::landing, Reason::commanded);
}

void Flight::refuse(Reason reason) {
  reason_ = reason;
  ++reason_count_;
}

}  // namespace fw
