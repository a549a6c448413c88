// Bytes of the ESCs on I2C: set-points out, status in.
//
//   Address  0x28 + n for motor n = 1..4
//   Write    hi = v >> 3, lo = v & 7, CRC-8 (poly 0x07, init 0) over address << 1, hi, lo
//   Read     bus current mA int16, RPM uint16 (little-endian), flags, CRC-8 over address << 1 | 1 and
//            the five bytes
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "firmware/status.hpp"

namespace fw {

struct EscStatus {
  std::int16_t current_mA = 0;
  std::uint16_t speed_rpm = 0;
  std::uint8_t flags = 0;
};

namespace esc_wire {

enum Flag : std::uint8_t {
  kArmed = 1 << 0,
  kTurning = 1 << 1,
  kSaturated = 1 << 2,
  kOverCurrent = 1 << 3,
  kUnderVoltage = 1 << 4,
  kDesync = 1 << 5,
  kUncalibrated = 1 << 6,
  kWriteRejected = 1 << 7,
};

constexpr std::uint8_t address_of(unsigned motor) {  // 0..3 here, 1..4 on the frame
  return static_cast<std::uint8_t>(0x29 + motor);
}

constexpr std::uint8_t crc8(std::uint8_t crc, std::uint8_t byte) {
  crc = static_cast<std::uint8_t>(crc ^ byte);
  for (int i = 0; i < 8; ++i) {
    crc = static_cast<std::uint8_t>((crc & 0x80) != 0 ? (crc << 1) ^ 0x07 : crc << 1);
  }
  return crc;
}

constexpr std::array<std::uint8_t, 3> encode_setpoint(std::uint8_t address, std::uint16_t v) {
  const auto hi = static_cast<std::uint8_t>(v >> 3), lo = static_cast<std::uint8_t>(v & 7);
  const std::uint8_t seed = crc8(0, static_cast<std::uint8_t>(address << 1));
  return {hi, lo, crc8(crc8(seed, hi), lo)};
}

constexpr Status decode_status(std::uint8_t address, std::span<const std::uint8_t, 6> bytes,
                               EscStatus& out) {
  std::uint8_t crc = crc8(0, static_cast<std::uint8_t>(address << 1 | 1));
  for (const std::uint8_t byte : bytes.first<5>()) crc = crc8(crc, byte);
  if (crc != bytes[5]) return Status::bad_data;
  out.current_mA = static_cast<std::int16_t>(bytes[0] | bytes[1] << 8);
  out.speed_rpm = static_cast<std::uint16_t>(bytes[2] | bytes[3] << 8);
  out.flags = bytes[4];
  return Status::ok;
}

}  // namespace esc_wire
}  // namespace fw
