// Bytes of an ESC on I2C, for both ends: the flight image writes set-points, the ESC answers status.
//
//   Address  0x28 + n for motor n = 1..4
//   Write    hi = v >> 3, lo = v & 7 (upper bits 0), CRC-8 over address << 1, hi, lo
//   Read     bus current mA int16, RPM uint16 (little-endian), flags, CRC-8 over address << 1 | 1 and
//            the five bytes
//   CRC-8    poly 0x07, init 0, not reflected (CRC-8/SMBUS)
//   Peer     the stand's codec (io_bridges/protocols/esc_codec.hpp) is a second reading of the same
//            page, so that a slip here is heard; tests/protocol_test.cpp holds both to the same frames
#pragma once
#include <array>
#include <cstdint>
#include <span>

namespace fw::esc {

enum Flag : std::uint8_t {
  flag_armed = 1 << 0,
  flag_turning = 1 << 1,
  flag_saturated = 1 << 2,
  flag_over_current = 1 << 3,
  flag_under_voltage = 1 << 4,
  flag_desync = 1 << 5,
  flag_uncalibrated = 1 << 6,    // or, in modes 4 and 5, the current sense not warm yet
  flag_write_rejected = 1 << 7,  // since the last read
};

namespace protocol {

using SetpointBytes = std::array<std::uint8_t, 3>;
using StatusBytes = std::array<std::uint8_t, 6>;

struct Status {
  std::int16_t current_mA = 0;
  std::uint16_t speed_rpm = 0;
  std::uint8_t flags = 0;
};

constexpr std::uint8_t address_of(unsigned motor) {  // 1..4
  return static_cast<std::uint8_t>(0x28 + motor);
}

// A byte at a time, for it runs in an interrupt: eight shifts multiply by x^8, which is x^2 + x + 1 here;
// what that carries beyond the eighth bit is two bits, multiplied once more.
constexpr std::uint8_t crc8(std::uint8_t crc, std::span<const std::uint8_t> bytes) {
  constexpr auto times_7 = [](std::uint32_t x) { return x ^ x << 1 ^ x << 2; };  // without carries
  for (const std::uint8_t byte : bytes) {
    const std::uint32_t product = times_7(static_cast<std::uint32_t>(crc ^ byte));
    crc = static_cast<std::uint8_t>(product ^ times_7(product >> 8));
  }
  return crc;
}

// The address byte takes part, as it stands on the wire.
constexpr std::uint8_t crc_of(std::uint8_t address, bool read,
                              std::span<const std::uint8_t> payload) {
  const std::array<std::uint8_t, 1> first{static_cast<std::uint8_t>(address << 1 | (read ? 1 : 0))};
  return crc8(crc8(0, first), payload);
}

constexpr SetpointBytes encode_setpoint(std::uint8_t address, std::uint16_t v) {
  SetpointBytes bytes{static_cast<std::uint8_t>(v >> 3), static_cast<std::uint8_t>(v & 7), 0};
  bytes[2] = crc_of(address, false, std::span(bytes).first<2>());
  return bytes;
}

// False: wrong length, CRC or upper bits of lo; v is left as it was.
constexpr bool decode_setpoint(std::uint8_t address, std::span<const std::uint8_t> bytes,
                               std::uint16_t& v) {
  if (bytes.size() != 3 || bytes[1] > 7) return false;
  if (bytes[2] != crc_of(address, false, bytes.first(2))) return false;
  v = static_cast<std::uint16_t>(bytes[0] << 3 | bytes[1]);
  return true;
}

constexpr StatusBytes encode_status(std::uint8_t address, const Status& status) {
  const auto current = static_cast<std::uint16_t>(status.current_mA);
  StatusBytes bytes{static_cast<std::uint8_t>(current & 0xFF),
                    static_cast<std::uint8_t>(current >> 8),
                    static_cast<std::uint8_t>(status.speed_rpm & 0xFF),
                    static_cast<std::uint8_t>(status.speed_rpm >> 8),
                    status.flags,
                    0};
  bytes[5] = crc_of(address, true, std::span(bytes).first<5>());
  return bytes;
}

// False: wrong CRC; the status is left as it was.
constexpr bool decode_status(std::uint8_t address, std::span<const std::uint8_t, 6> bytes,
                             Status& status) {
  if (bytes[5] != crc_of(address, true, bytes.first<5>())) return false;
  status.current_mA = static_cast<std::int16_t>(bytes[0] | bytes[1] << 8);
  status.speed_rpm = static_cast<std::uint16_t>(bytes[2] | bytes[3] << 8);
  status.flags = bytes[4];
  return true;
}

}  // namespace protocol
}  // namespace fw::esc
