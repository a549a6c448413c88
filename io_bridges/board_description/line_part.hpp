// Parts of a board that can be played on the serial line of their own UART, or are at its other end.
#pragma once
#include "io_bridges/board_description/board_description.hpp"
#include "io_bridges/board_description/bus_kind.hpp"
#include "io_bridges/board_description/bus_name.hpp"

namespace whirl {

// One that speaks SBUS.
inline bool is_receiver(const BoardDevice& device) {
  return device.type == "sbus" && is_uart(device.bus);
}

inline bool is_gps(const BoardDevice& device) {
  return device.type.starts_with("ublox_") && is_uart(device.bus);
}

// One that carries MAVLink.
inline bool is_radio(const BoardDevice& device) {
  return device.type == "mavlink_link" && is_uart(device.bus);
}

inline bool is_at_uart(const BoardDevice& device, int uart) {
  return is_uart(device.bus) && bus_number(device.bus) == uart;
}

}  // namespace whirl
