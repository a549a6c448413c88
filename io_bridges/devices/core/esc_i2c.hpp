// An ESC as its I2C master sees it: set-points in, status out. What turns the motor is elsewhere.
//
//   Writes   3 bytes with a good CRC are a set-point; any other is ignored, counted, and shows in
//            flag bit 7 of the next status read. A write ends at STOP or repeated START.
//   Reads    6 bytes of status, frozen at START; beyond them 0xFF
//   Bytes    set-point: v >> 3, v & 7, CRC; status: current in mA and mechanical RPM, low byte first,
//            flags, CRC. CRC-8 (polynomial 0x07) over the address byte as it stands on the wire, then
//            the bytes before it
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace whirl::core {

struct EscStatusCounts {
  std::int16_t current_mA = 0;
  std::uint16_t speed_rpm = 0;
  std::uint8_t flags = 0;
};

inline constexpr std::uint8_t kEscWriteRejected = 1u << 7;

std::uint8_t esc_crc(std::uint8_t address, bool read, std::span<const std::uint8_t> payload);
// Nothing when the length, the CRC or the upper bits of the second byte are wrong.
std::optional<std::uint16_t> esc_setpoint(std::uint8_t address,
                                          std::span<const std::uint8_t> bytes);
std::array<std::uint8_t, 6> esc_status(std::uint8_t address, const EscStatusCounts& status);

class EscI2c {
 public:
  struct Write {
    bool valid = false;
    std::uint16_t v = 0;  // 0 when not valid
  };

  explicit constexpr EscI2c(std::uint8_t address_7bit) : address_(address_7bit) {}

  std::uint8_t address() const { return address_; }
  void set_status(const EscStatusCounts& status) { status_ = status; }
  std::uint32_t writes() const { return writes_; }
  std::uint32_t rejected() const { return rejected_; }

  // A START or STOP ends the write before it, which both return.
  std::optional<Write> start(bool read);
  void write(std::uint8_t byte);
  std::uint8_t read();
  std::optional<Write> stop();

 private:
  std::uint8_t address_;
  EscStatusCounts status_;
  bool writing_ = false;
  std::array<std::uint8_t, 4> received_{};  // four are enough to know it is too long
  std::size_t received_count_ = 0;
  std::array<std::uint8_t, 6> answer_{};
  std::size_t answered_ = 0;
  bool rejected_since_read_ = false;
  std::uint32_t writes_ = 0, rejected_ = 0;
};

}  // namespace whirl::core
