// Calibrations in the flight logic: when one may run, and what ends it.
#include "firmware/flight/flight.hpp"
#include "firmware/flight/schedule.hpp"

namespace fw {

MotorCurrents Flight::motor_currents_A() const {
  MotorCurrents current_A{};
  for (unsigned i = 0; i < 4; ++i) {
    current_A[i] = 1e-3f * static_cast<float>(motors_.status(i).current_mA);
  }
  return current_A;
}

void Flight::on_field(const Vector3& field_B_uT) {
  const MotorCurrents current_A = motor_currents_A();
  calibrator_.on_field(field_B_uT, current_A);
  estimator_.on_field(correction_.field(field_B_uT, current_A));
}

// Motors run only from a state in which it could be armed to fly, and armed: what then stops motors on the
// ground stops this, too.
Reason Flight::calibrate(Calibration what) {
  if (what == Calibration::none) {
    calibrator_.cancel();
    return Reason::none;
  }
  const Calibration running = calibrator_.running();
  if (running == what) {  // the station asks again
    calibrator_.answer_again();
    return Reason::none;
  }
  if (!allowed(Command::calibrate, state_)) return Reason::wrong_state;
  if (falling_) return Reason::falling;
  if (running != Calibration::none) return Reason::calibrating;
  if (imu_missing_ms_ > kImuLost_ms) return Reason::imu_not_running;
  if (imu_frozen_) return Reason::imu_frozen;
  if (motors_.any_turning()) return Reason::motors_turn;
  const bool by_field = what == Calibration::magnetometer || what == Calibration::motor_fields;
  if (by_field && !estimator_.field_fresh()) return Reason::no_field;
  if (what == Calibration::motor_fields) {
    if (steered_by_hand()) return Reason::by_hand;
    if (const Reason why_not = ready_to_arm(); why_not != Reason::none) return why_not;
    begin_armed();
  }
  calibrator_.start(what);
  return Reason::none;
}

void Flight::watch_calibration() {
  const Calibration running = calibrator_.running();
  if (running == Calibration::none) return;
  const bool with_motors = running == Calibration::motor_fields;
  const FlightState wanted = with_motors ? FlightState::armed : FlightState::disarmed;
  if (state_ != wanted || (with_motors && steered_by_hand())) {
    calibrator_.fail("calibration failed: interrupted");
  } else if (imu_missing_ms_ > kImuLost_ms || imu_frozen_) {
    calibrator_.fail(text_of(Reason::imu_not_running));
  } else if (running == Calibration::magnetometer && !estimator_.field_fresh()) {
    calibrator_.fail(text_of(Reason::no_field));
  }
  calibrator_.step(estimator_.w_WB_B_radps(), schedule::kAttitudeStep_s);
  const bool over = calibrator_.running() == Calibration::none;
  if (with_motors && over && state_ == FlightState::armed) stop_motors(Reason::commanded, false);
}

}  // namespace fw
