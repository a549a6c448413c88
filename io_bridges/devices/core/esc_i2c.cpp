#include "io_bridges/devices/core/esc_i2c.hpp"

#include "io_bridges/devices/core/crc8.hpp"

namespace whirl::core {
std::uint8_t esc_crc(std::uint8_t address, bool read, std::span<const std::uint8_t> payload) {
  std::uint8_t crc = crc8_add(0, static_cast<std::uint8_t>(address << 1 | (read ? 1 : 0)));
  for (const std::uint8_t byte : payload) crc = crc8_add(crc, byte);
  return crc;
}

std::optional<std::uint16_t> esc_setpoint(std::uint8_t address,
                                          std::span<const std::uint8_t> bytes) {
  if (bytes.size() != 3 || bytes[1] > 7) return std::nullopt;
  if (bytes[2] != esc_crc(address, false, bytes.first(2))) return std::nullopt;
  return static_cast<std::uint16_t>(bytes[0] << 3 | bytes[1]);
}

std::array<std::uint8_t, 6> esc_status(std::uint8_t address, const EscStatusCounts& status) {
  const auto current = static_cast<std::uint16_t>(status.current_mA);
  std::array<std::uint8_t, 6> bytes{static_cast<std::uint8_t>(current & 0xFF),
                                    static_cast<std::uint8_t>(current >> 8),
                                    static_cast<std::uint8_t>(status.speed_rpm & 0xFF),
                                    static_cast<std::uint8_t>(status.speed_rpm >> 8),
                                    status.flags,
                                    0};
  bytes[5] = esc_crc(address, true, std::span(bytes).first(5));
  return bytes;
}

std::optional<EscI2c::Write> EscI2c::start(bool read) {
  const auto ended = stop();
  if (!read) {
    writing_ = true;
    received_count_ = 0;
    return ended;
  }
  EscStatusCounts status = status_;
  if (rejected_since_read_) status.flags |= kEscWriteRejected;
  rejected_since_read_ = false;
  answer_ = esc_status(address_, status);
  answered_ = 0;
  return ended;
}

void EscI2c::write(std::uint8_t byte) {
  if (received_count_ < received_.size()) received_[received_count_++] = byte;
}

std::uint8_t EscI2c::read() {
  return answered_ < answer_.size() ? answer_[answered_++] : 0xFF;
}

std::optional<EscI2c::Write> EscI2c::stop() {
  if (!writing_) return std::nullopt;
  writing_ = false;
  ++writes_;
  const auto v = esc_setpoint(address_, std::span(received_).first(received_count_));
  if (!v) {
    ++rejected_;
    rejected_since_read_ = true;
  }
  return Write{v.has_value(), v.value_or(0)};
}

}  // namespace whirl::core
