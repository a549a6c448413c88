// uavcan.equipment.esc: set-points to the ESCs of a bus, and what each tells of itself.
//
//   RawCommand  -8192..8191 per ESC index, 0 stops; trailing zeros may be left out; the ESC gives its scale
//   RPMCommand  revolutions per minute of the shaft (the protocol's unit)
//   Status      temperature in kelvin; error_count restarts with the motor
#pragma once
#include "io_bridges/protocols/dronecan/data_type.hpp"
#include "io_bridges/protocols/dronecan/fields.hpp"

namespace whirl::io::dronecan {

inline constexpr std::size_t kMost_escs = 20;

struct RawCommand {
  static constexpr DataType kType{Kind::message, 1030, 0x217F5C87D7EC951D, 35, "esc.RawCommand"};
  static constexpr std::int16_t kFull = 8191;
  Bounded<std::int16_t, kMost_escs> commands{};

  template <typename F>
  void layout(F& f) {
    f.tail(commands, 14, [&](std::int16_t& command) { f.i(command, 14); });
  }
};

struct RpmCommand {
  static constexpr DataType kType{Kind::message, 1031, 0xCE0F9F621CF7E70B, 45, "esc.RPMCommand"};
  Bounded<std::int32_t, kMost_escs> speeds_rpm{};

  template <typename F>
  void layout(F& f) {
    f.tail(speeds_rpm, 18, [&](std::int32_t& speed) { f.i(speed, 18); });
  }
};

struct EscStatus {
  static constexpr DataType kType{Kind::message, 1034, 0xA9AF28AEA2FBB254, 14, "esc.Status"};
  std::uint32_t error_count = 0;
  float voltage_V = 0, current_A = 0, temperature_K = 0;
  std::int32_t speed_rpm = 0;
  std::uint8_t power_pct = 0;  // of the rating
  std::uint8_t index = 0;      // 0..31

  template <typename F>
  void layout(F& f) {
    f.u(error_count, 32);
    f.f16(voltage_V);
    f.f16(current_A);
    f.f16(temperature_K);
    f.i(speed_rpm, 18);
    f.u(power_pct, 7);
    f.u(index, 5);
  }
};

}  // namespace whirl::io::dronecan
