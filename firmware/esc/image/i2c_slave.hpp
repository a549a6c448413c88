// I2C2 as a slave: set-points in, status out, all in the interrupt; nothing is stretched longer than
// the interrupt takes.
//
//   Bytes   ESC protocol: write hi, lo, crc; read current, speed, flags, crc, then 0xFF
#pragma once
#include <cstdint>

#include "firmware/esc/core/protocol.hpp"

namespace fw::esc::i2c_slave {

void start(std::uint8_t address_7bit);
void publish(const protocol::Status& status);
// A valid set-point that has come in since the last call.
bool take_setpoint(std::uint16_t& v);
// Once per tick: sets the block up anew when the bus has been busy for 25 ms without an event, as a
// stuck line or a master that went away in mid-byte leaves it.
void supervise();
std::uint32_t restarts();
std::uint32_t rejected();

}  // namespace fw::esc::i2c_slave
