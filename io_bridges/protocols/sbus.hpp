// SBUS frames: 25 bytes, sixteen channels of 11 bits, two of one bit, two flags. No checksum.
//
//   Line     100000 baud, 8 data bits, even parity, 2 stop bits, inverted
//   Frame    0F; 22 bytes of channels, low bits first; flags; 00
//   Flags    bit 0 channel 17, 1 channel 18, 2 frame lost, 3 failsafe
//   Values   172..1811 are -100..+100 % of travel, 992 the centre
//   Source   bolderflight/sbus README, PX4 sbus.c, Betaflight rx/sbus.c: they agree; no document of
//            Futaba's was at hand
#pragma once
#include <array>
#include <cstdint>

#include "io_bridges/devices/core/receiver.hpp"

namespace whirl::io {

using core::receiver::kSbusBytes, core::receiver::kSbusFailsafe, core::receiver::kSbusFrameLost;

struct SbusFrame {
  std::array<std::uint16_t, 16> channels{};  // 0..2047
  std::uint8_t flags = 0;
};

std::array<std::uint8_t, kSbusBytes> encode(const SbusFrame& frame);
// -1..1 of travel, rounded, kept within 0..2047.
std::uint16_t sbus_of_travel(double travel);

}  // namespace whirl::io
