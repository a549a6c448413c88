// CAN as a node of DroneCAN at 1 Mbit/s (PA11, PA12): set-points by esc.RawCommand, esc.Status and
// StatusExtended out, NodeStatus, GetNodeInfo, and the motor's number by param.GetSet.
//
//   Node id    0x28 + motor number, as the address on I2C
//   Set-point  index motor - 1; four steps of the command are one of the I2C protocol's 2047, so 0 stops
//              and 8191 is the top of the mode's range. Negative ones are refused: flag bit 7, once
//   Speed      esc.RPMCommand at the same index, in the mode whose set-points are speeds: to the nearest step of its
//              range (2.4 rpm); 0 stops. In another mode, or beyond the range: refused
//   Quiet      it sends nothing until it has heard a frame for it: an ESC on I2C has no CAN
//   Watchdog   the core's: half a second without a valid set-point, from whatever source
#pragma once
#include <cstdint>

#include "firmware/esc/core/setpoint.hpp"

namespace fw::esc::can_node {

struct Report {
  float voltage_V = 0.0f, current_A = 0.0f;
  std::int32_t speed_rpm = 0;
  std::uint8_t flags = 0;
};

void start(std::uint32_t motor_number);
// A valid set-point that has come in since the last call.
bool take_setpoint(Mode mode, std::uint16_t& v);
// Once per tick of 1 ms: answers, and tells its state when that is due.
void publish(const Report& report);

}  // namespace fw::esc::can_node
