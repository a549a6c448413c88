// What the vehicle says and hears over MAVLink: a slot every 5 ms, at most one message in each, so
// that the 57600 baud of a half-duplex radio are filled evenly.
//
//   Down    HEARTBEAT 1 Hz, SYS_STATUS 1 Hz, ATTITUDE_QUATERNION 20 Hz, LOCAL_POSITION_NED 10 Hz,
//           HIGHRES_IMU 2 Hz, DEBUG_FLOAT_ARRAY of the filters 5 and 4 Hz, of drag 1 Hz, GPS_RAW_INT
//           1 Hz (with capture 0.2 Hz), GPS_GLOBAL_ORIGIN 1 Hz once there is one; COMMAND_ACK, STATUSTEXT and
//           PARAM_VALUE in free slots
//   Up      VICON_POSITION_ESTIMATE, SET_POSITION_TARGET_LOCAL_NED, SET_ATTITUDE_TARGET (attitude, body
//           yaw rate and thrust), COMMAND_LONG (400 arm, disarm;
//           22 take off to param 7; 21 land; 241 calibrate by param 1, 2, 5 or 6; 512 of AUTOPILOT_VERSION, 520: it is sent; any other is
//           acknowledged as unsupported); the requests of parameter_link.hpp and request_link.hpp
//   State   HEARTBEAT.custom_mode is the FlightState; system_status 2 not ready, 3 ready, 4 active,
//           5 failsafe, 6 motors stopped in an emergency
#pragma once
#include <array>
#include <concepts>
#include <cstdint>
#include <span>

#include "firmware/flight/flight.hpp"
#include "firmware/link/mavlink.hpp"
#include "firmware/link/parameter_link.hpp"
#include "firmware/link/request_link.hpp"
#include "firmware/status.hpp"

namespace fw {

struct Health {  // what only the image knows
  std::uint16_t load_permille = 0;
  const char* boot_text = "";         // reset cause, sent once
  bool parameters_unsaved = false;    // flash did not take the last change
  const char* log_trouble = nullptr;  // why there is no log, or not all of it; null: all is well
};

class Telemetry {
 public:
  explicit Telemetry(Flight& flight) : flight_(flight) {}

  void receive(std::span<const std::uint8_t> bytes);
  // The message of this slot, or nothing. Valid until the next call.
  std::span<const std::uint8_t> next(std::uint32_t time_ms, const Faults& faults,
                                     const Health& health);
  std::uint32_t bad_frames() const { return parser_.bad_frames(); }

 private:
  void on_vicon(const mavlink::Frame& frame);
  void on_target(const mavlink::Frame& frame);
  void on_attitude(const mavlink::Frame& frame);
  Reason arm_or_disarm(bool arm, bool force);
  void on_command(const mavlink::Frame& frame);

  mavlink::Message heartbeat() const;
  mavlink::Message sys_status(const Faults& faults, const Health& health) const;
  mavlink::Message attitude(std::uint32_t time_ms) const;
  mavlink::Message position(std::uint32_t time_ms) const;
  mavlink::Message highres_imu(std::uint32_t time_ms) const;
  mavlink::Message gps_raw(std::uint32_t time_ms) const;
  mavlink::Message gps_origin() const;
  mavlink::Message filters(std::uint32_t time_ms) const;
  mavlink::Message filter_attitudes(std::uint32_t time_ms) const;
  mavlink::Message drag(std::uint32_t time_ms) const;
  static mavlink::Message float_array(std::uint32_t time_ms, std::uint16_t id, const char* name,
                                      std::uint8_t count);
  void refuse(std::uint16_t command, Reason reason);
  void on_request_message(float message);
  void on_calibration(const mavlink::Frame& frame);
  void acknowledge(std::uint16_t command, std::uint8_t result, std::uint8_t percent = 0);
  mavlink::Message ack();
  static mavlink::Message status_text(const char* text, bool bad);
  std::span<const std::uint8_t> send(const mavlink::Message& message);

  Flight& flight_;
  mavlink::Parser parser_;
  ParameterLink parameters_;
  RequestLink requests_;
  mavlink::Message last_{mavlink::kHeartbeat, 9};
  std::uint32_t slot_ = 0;
  std::uint8_t sequence_ = 0;
  struct Ack {
    std::uint16_t command = 0;
    std::uint8_t result = 0, percent = 0;
  };
  std::array<Ack, 8> acks_{};  // due; those of a burst beyond are lost, and asked for again
  std::size_t acks_due_ = 0;
  Reason refusal_ = Reason::none;
  std::uint32_t reasons_told_ = 0;
  const char* log_told_ = nullptr;
  bool refusal_due_ = false, booted_told_ = false, unsaved_told_ = false;
};

}  // namespace fw
