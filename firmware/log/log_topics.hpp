// What a flight log holds: the topics with their fields. Topics and fields that PX4 has are spelled as
// there, so that its tools know them; a topic here may have fewer fields.
//
//   Units   SI, as PX4's messages state them; Gauss for the magnetic field
//   Frames  local position: north-east-down; gyro_rad, accelerometer_m_s2, xyz, magnetometer_ga: forward-right-down
#pragma once
#include <cstdint>
#include <string_view>

namespace fw::log {

enum class Topic : std::uint16_t {
  vehicle_attitude,
  sensor_combined,
  vehicle_angular_velocity,
  vehicle_local_position,
  actuator_outputs,
  vehicle_local_position_setpoint,
  flight_status,
  esc_status,
  battery_status,
  cpuload,
  flight_timing,
  vehicle_air_data,
  vehicle_magnetometer,
};

inline constexpr std::size_t kTopics = 13;

// Two that are longer than a line.
inline constexpr std::string_view kLocalPosition =
    "vehicle_local_position:uint64_t timestamp;float x;float y;float z;float vx;float vy;float vz;"
    "float heading;";
// The worst since the one before: from the IMU's data-ready to the start of the tick, and to the
// set-points' way to the ESCs; the length of a tick.
inline constexpr std::string_view kTiming =
    "flight_timing:uint64_t timestamp;uint16_t start_us;uint16_t setpoint_us;uint16_t tick_us;"
    "uint32_t deadlines_missed;";

// In the order of Topic; then the formats that others contain.
inline constexpr std::string_view kFormats[] = {
    "vehicle_attitude:uint64_t timestamp;float[4] q;",
    "sensor_combined:uint64_t timestamp;float[3] gyro_rad;float[3] accelerometer_m_s2;",
    "vehicle_angular_velocity:uint64_t timestamp;float[3] xyz;",
    kLocalPosition,
    // Of the ESCs' set-points: 1 to 2047, 0 stops the motor.
    "actuator_outputs:uint64_t timestamp;uint32_t noutputs;float[4] output;",
    "vehicle_local_position_setpoint:uint64_t timestamp;float x;float y;float z;float yaw;",
    // FlightState and Reason (flight/flight.hpp).
    "flight_status:uint64_t timestamp;uint8_t state;uint8_t reason;uint8_t emergency;",
    // esc_state: the flags of the ESC's status.
    "esc_status:uint64_t timestamp;uint8_t esc_count;esc_report[4] esc;",
    "battery_status:uint64_t timestamp;float current_a;",  // sum of what the ESCs tell
    "cpuload:uint64_t timestamp;float load;",
    kTiming,
    "vehicle_air_data:uint64_t timestamp;float baro_pressure_pa;",
    "vehicle_magnetometer:uint64_t timestamp;float[3] magnetometer_ga;",
    "esc_report:uint64_t timestamp;int32_t esc_rpm;float esc_current;uint8_t esc_state;",
};
static_assert(std::size(kFormats) == kTopics + 1);

constexpr std::string_view name_of(std::size_t topic) {
  return kFormats[topic].substr(0, kFormats[topic].find(':'));
}
// The enumeration and the table stand in the same order.
static_assert(name_of(static_cast<std::size_t>(Topic::sensor_combined)) == "sensor_combined");
static_assert(name_of(static_cast<std::size_t>(Topic::flight_status)) == "flight_status");
static_assert(name_of(static_cast<std::size_t>(Topic::vehicle_magnetometer)) ==
              "vehicle_magnetometer");

}  // namespace fw::log
