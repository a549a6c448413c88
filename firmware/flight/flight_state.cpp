#include "firmware/flight/flight_state.hpp"

namespace fw {

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
    case Reason::imu_implausible:
      return "IMU does not feel gravity at rest";
    case Reason::no_position:
      return "no position";
    case Reason::estimate_not_converged:
      return "estimate not converged";
    case Reason::tilted:
      return "not level";
    case Reason::esc_not_armed:
      return "an ESC is not armed";
    case Reason::esc_fault:
      return "an ESC reports a fault";
    case Reason::esc_over_current:
      return "an ESC had too much current";
    case Reason::esc_not_warm:
      return "an ESC's current sense cold or uncalibrated";
    case Reason::esc_silent:
      return "an ESC is silent";
    case Reason::motor_out:
      return "a motor has stopped";
    case Reason::no_setpoints:
      return "set-points stopped";
    case Reason::no_link:
      return "radio link lost";
    case Reason::rc_lost:
      return "radio control lost";
    case Reason::rc_nonsense:
      return "radio control gives nonsense";
    case Reason::throttle_high:
      return "throttle is not low";
    case Reason::by_hand:
      return "flown by hand";
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
    case Reason::outside_fence:
      return "outside the fence";
    case Reason::battery_low:
      return "battery low";
    case Reason::battery_empty:
      return "battery empty";
    case Reason::no_battery:
      return "battery voltage not measured";
    case Reason::no_pressure:
      return "barometer silent or out of range";
    case Reason::no_field:
      return "magnetometer silent or out of range";
    case Reason::heading_by_gyro:
      return "heading by gyro for too long";
    case Reason::off_course:
      return "course not kept";
    case Reason::by_drag:
      return "no position: velocity by drag";
    case Reason::calibrating:
      return "a calibration runs";
    case Reason::motors_turn:
      return "motors turn";
    case Reason::falling:
      return "motors stopped in the air";
    case Reason::killed:
      return "motors stopped by command";
    case Reason::restarted:
      return "restarted in the air";
    case Reason::attitude_lost:
      return "attitude unknown";
    case Reason::too_low:
      return "too low to restart";
  }
  return "";
}

}  // namespace fw
