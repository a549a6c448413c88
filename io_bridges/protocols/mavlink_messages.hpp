// The messages of First flight as plain structs, and pack/unpack for all of them.
//
//   Names   fields are spelled as the MAVLink message definitions spell them; units are theirs:
//           metres, radians, m/s2, rad/s, but mV, cA, hPa, degC, Gauss where the definition says so
//   Layout  fields() lists the wire order (by element size, extensions last), once, for both ways
//   Error   golden frames (tests/mavlink_test.cpp); each size equals the table's max_length
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "io_bridges/protocols/mavlink.hpp"

namespace whirl::io {

struct Heartbeat {
  static constexpr std::uint32_t kId = 0;
  std::uint32_t custom_mode = 0;
  std::uint8_t type = 0, autopilot = 0, base_mode = 0, system_status = 0, mavlink_version = 3;
  template <typename V>
  void fields(V& v) {
    v(custom_mode, type, autopilot, base_mode, system_status, mavlink_version);
  }
};

struct SysStatus {  // voltage in mV, current in cA, load in 0.1 %
  static constexpr std::uint32_t kId = 1;
  std::uint32_t sensors_present = 0, sensors_enabled = 0, sensors_health = 0;
  std::uint16_t load = 0, voltage_battery = 0;
  std::int16_t current_battery = -1;
  std::uint16_t drop_rate_comm = 0, errors_comm = 0;
  std::array<std::uint16_t, 4> errors_count{};
  std::int8_t battery_remaining = -1;
  std::array<std::uint32_t, 3> extended{};  // present, enabled, health
  template <typename V>
  void fields(V& v) {
    v(sensors_present, sensors_enabled, sensors_health, load, voltage_battery, current_battery,
      drop_rate_comm, errors_comm, errors_count, battery_remaining, extended);
  }
};

// A parameter's name as it travels: sixteen characters, the rest zero; all sixteen may be used.
using ParamId = std::array<char, 16>;
inline ParamId to_param_id(std::string_view name) {
  ParamId id{};
  std::copy_n(name.begin(), std::min(name.size(), id.size()), id.begin());
  return id;
}
inline std::string param_name(const ParamId& id) {
  return {id.data(), strnlen(id.data(), id.size())};
}
inline constexpr std::uint8_t kParamReal32 = 9;  // MAV_PARAM_TYPE

struct ParamRequestRead {
  static constexpr std::uint32_t kId = 20;
  std::int16_t param_index = -1;  // -1: by its name
  std::uint8_t target_system = 0, target_component = 0;
  ParamId param_id{};
  template <typename V>
  void fields(V& v) {
    v(param_index, target_system, target_component, param_id);
  }
};

struct ParamRequestList {
  static constexpr std::uint32_t kId = 21;
  std::uint8_t target_system = 0, target_component = 0;
  template <typename V>
  void fields(V& v) {
    v(target_system, target_component);
  }
};

struct ParamValue {
  static constexpr std::uint32_t kId = 22;
  float param_value = 0;
  std::uint16_t param_count = 0, param_index = 0;
  ParamId param_id{};
  std::uint8_t param_type = kParamReal32;
  template <typename V>
  void fields(V& v) {
    v(param_value, param_count, param_index, param_id, param_type);
  }
};

struct ParamSet {
  static constexpr std::uint32_t kId = 23;
  float param_value = 0;
  std::uint8_t target_system = 0, target_component = 0;
  ParamId param_id{};
  std::uint8_t param_type = kParamReal32;
  template <typename V>
  void fields(V& v) {
    v(param_value, target_system, target_component, param_id, param_type);
  }
};

struct AttitudeQuaternion {  // q1..q4 = w, x, y, z
  static constexpr std::uint32_t kId = 31;
  std::uint32_t time_boot_ms = 0;
  float q1 = 1, q2 = 0, q3 = 0, q4 = 0, rollspeed = 0, pitchspeed = 0, yawspeed = 0;
  std::array<float, 4> repr_offset_q{};
  template <typename V>
  void fields(V& v) {
    v(time_boot_ms, q1, q2, q3, q4, rollspeed, pitchspeed, yawspeed, repr_offset_q);
  }
};

struct LocalPositionNed {
  static constexpr std::uint32_t kId = 32;
  std::uint32_t time_boot_ms = 0;
  float x = 0, y = 0, z = 0, vx = 0, vy = 0, vz = 0;
  template <typename V>
  void fields(V& v) {
    v(time_boot_ms, x, y, z, vx, vy, vz);
  }
};

struct GpsGlobalOrigin {  // degrees x 1e7; the flight image tells mm over the ellipsoid
  static constexpr std::uint32_t kId = 49;
  std::int32_t latitude = 0, longitude = 0, altitude = 0;
  std::uint64_t time_usec = 0;
  template <typename V>
  void fields(V& v) {
    v(latitude, longitude, altitude, time_usec);
  }
};

struct CommandLong {
  static constexpr std::uint32_t kId = 76;
  std::array<float, 7> param{};  // param[0] is the definition's param1
  std::uint16_t command = 0;
  std::uint8_t target_system = 0, target_component = 0, confirmation = 0;
  template <typename V>
  void fields(V& v) {
    v(param, command, target_system, target_component, confirmation);
  }
};

struct CommandAck {
  static constexpr std::uint32_t kId = 77;
  std::uint16_t command = 0;
  std::uint8_t result = 0, progress = 0;
  std::int32_t result_param2 = 0;
  std::uint8_t target_system = 0, target_component = 0;
  template <typename V>
  void fields(V& v) {
    v(command, result, progress, result_param2, target_system, target_component);
  }
};

struct SetAttitudeTarget {  // q: w, x, y, z; thrust 0..1
  static constexpr std::uint32_t kId = 82;
  std::uint32_t time_boot_ms = 0;
  std::array<float, 4> q{1, 0, 0, 0};
  float body_roll_rate = 0, body_pitch_rate = 0, body_yaw_rate = 0, thrust = 0;
  std::uint8_t target_system = 0, target_component = 0, type_mask = 0;
  std::array<float, 3> thrust_body{};
  template <typename V>
  void fields(V& v) {
    v(time_boot_ms, q, body_roll_rate, body_pitch_rate, body_yaw_rate, thrust, target_system,
      target_component, type_mask, thrust_body);
  }
};

struct SetPositionTargetLocalNed {
  static constexpr std::uint32_t kId = 84;
  std::uint32_t time_boot_ms = 0;
  float x = 0, y = 0, z = 0, vx = 0, vy = 0, vz = 0, afx = 0, afy = 0, afz = 0;
  float yaw = 0, yaw_rate = 0;
  std::uint16_t type_mask = 0;
  std::uint8_t target_system = 0, target_component = 0, coordinate_frame = 0;
  template <typename V>
  void fields(V& v) {
    v(time_boot_ms, x, y, z, vx, vy, vz, afx, afy, afz, yaw, yaw_rate, type_mask, target_system,
      target_component, coordinate_frame);
  }
};

struct ViconPositionEstimate {
  static constexpr std::uint32_t kId = 104;
  std::uint64_t usec = 0;
  float x = 0, y = 0, z = 0, roll = 0, pitch = 0, yaw = 0;
  std::array<float, 21> covariance{};
  template <typename V>
  void fields(V& v) {
    v(usec, x, y, z, roll, pitch, yaw, covariance);
  }
};

struct HighresImu {  // pressures in hPa, magnetic field in Gauss, temperature in degC
  static constexpr std::uint32_t kId = 105;
  std::uint64_t time_usec = 0;
  float xacc = 0, yacc = 0, zacc = 0, xgyro = 0, ygyro = 0, zgyro = 0, xmag = 0, ymag = 0, zmag = 0;
  float abs_pressure = 0, diff_pressure = 0, pressure_alt = 0, temperature = 0;
  std::uint16_t fields_updated = 0;
  std::uint8_t id = 0;
  template <typename V>
  void fields(V& v) {
    v(time_usec, xacc, yacc, zacc, xgyro, ygyro, zgyro, xmag, ymag, zmag, abs_pressure,
      diff_pressure, pressure_alt, temperature, fields_updated, id);
  }
};

struct Timesync {  // tc1: 0 in a request, in an answer the answering side's time; ns
  static constexpr std::uint32_t kId = 111;
  std::int64_t tc1 = 0, ts1 = 0;
  std::uint8_t target_system = 0, target_component = 0;
  template <typename V>
  void fields(V& v) {
    v(tc1, ts1, target_system, target_component);
  }
};

struct Statustext {
  static constexpr std::uint32_t kId = 253;
  std::uint8_t severity = 0;
  std::array<char, 50> text{};
  std::uint16_t id = 0;
  std::uint8_t chunk_seq = 0;
  template <typename V>
  void fields(V& v) {
    v(severity, text, id, chunk_seq);
  }
  void set_text(std::string_view words) {
    text = {};
    std::copy_n(words.begin(), std::min(words.size(), text.size()), text.begin());
  }
  std::string string() const { return {text.data(), strnlen(text.data(), text.size())}; }
};

struct DebugFloatArray {
  static constexpr std::uint32_t kId = 350;
  std::uint64_t time_usec = 0;
  std::uint16_t array_id = 0;
  std::array<char, 10> name{};
  std::array<float, 58> data{};
  template <typename V>
  void fields(V& v) {
    v(time_usec, array_id, name, data);
  }
};

namespace detail {

struct Packer {
  std::uint8_t* to;
  template <typename... Fields>
  void operator()(const Fields&... fields) {
    ((std::memcpy(to, &fields, sizeof fields), to += sizeof fields), ...);
  }
};

struct Unpacker {
  const std::uint8_t* from;
  template <typename... Fields>
  void operator()(Fields&... fields) {
    ((std::memcpy(&fields, from, sizeof fields), from += sizeof fields), ...);
  }
};

}  // namespace detail

struct MavlinkSender {
  std::uint8_t sysid = 255;
  std::uint8_t compid = 190;
  std::uint8_t seq = 0;  // counts up with every frame that pack() makes
};

// Little-endian hosts only, as all of ours are.
template <typename Message>
MavlinkFrame pack(Message message, MavlinkSender& sender) {
  MavlinkFrame frame;
  frame.seq = sender.seq++;
  frame.sysid = sender.sysid;
  frame.compid = sender.compid;
  frame.msgid = Message::kId;
  detail::Packer packer{frame.payload.data()};
  message.fields(packer);
  frame.length = static_cast<std::uint8_t>(packer.to - frame.payload.data());
  return frame;
}

template <typename Message>
std::optional<Message> unpack(const MavlinkFrame& frame) {
  if (frame.msgid != Message::kId) return std::nullopt;
  Message message;
  detail::Unpacker unpacker{frame.payload.data()};
  message.fields(unpacker);
  return message;
}

}  // namespace whirl::io
