// The words of the flight logic: where a flight is, who steers, and why something ended or was refused.
#pragma once
#include <cstdint>

namespace fw {

// Told as HEARTBEAT custom_mode.
enum class FlightState : std::uint8_t { disarmed, armed, flying, landing, failsafe };

enum class Reason : std::uint8_t {  // why a command was refused, or a flight ended
  none,
  imu_not_running,
  imu_frozen,
  imu_not_calibrated,
  imu_implausible,
  no_position,
  estimate_not_converged,
  tilted,
  esc_not_armed,
  esc_fault,
  esc_silent,
  motor_out,
  no_setpoints,
  no_link,
  rc_lost,
  rc_nonsense,
  throttle_high,
  by_hand,
  tipped_over,
  landed,
  commanded,
  wrong_state,
  height_out_of_range,
  outside_fence,
  battery_low,
  battery_empty,
  no_battery,
  no_pressure,
  no_field,
  by_drag,
  calibrating,
  motors_turn,
  falling,
  killed,
  restarted,
  attitude_lost,
  too_low,
  esc_over_current,
  heading_by_gyro,
  off_course,
  esc_not_warm,
};
const char* text_of(Reason reason);

}  // namespace fw
