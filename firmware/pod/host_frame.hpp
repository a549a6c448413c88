// The frames between pod and host on the UART at 3 Mbaud: 0xA5, kind, sequence, length, payload, CRC-16
// (as in link/crc16.hpp, over kind to payload, low byte first). Each direction counts its sequence per
// kind.
//
//   Host to pod   0x01 sample: the host's time of it (u16, us, wraps), 7 x int16 (accelerometer, temperature, gyro;
//                 counts)
//                 0x02 faults: flags (bit 0 frozen, bit 1 no supply), identity (0: its own)
//                 0x03 barometer: quantity (0 pressure, 1 temperature), counts (u32)
//                 0x04 its PROM: 8 x u16      0x05 magnetometer: 3 x int16 (x, y, z; counts)
//                 0x06 an ESC's status: number 0..3, current (int16, mA), speed (u16, rpm), flags
//                 0x07 bytes of the GPS: from when on (u32, the pod's us; 0: at once), at most 44
//                 0x08 its baud rate (u32)
//                 0x09 SBUS: 22 bytes of channels as on the line, flags (bit 7: nothing goes out)
//                 0x0A CPPM: at most 16 x u16, lengths in 0.5 us; none: nothing goes out
//                 0x0B bytes of the radio, as of the GPS      0x0C its baud rate (u32)
//                 0x0D the battery's level at the ADC: u16, of 4095
//   Pod to host   0x81 status, see host_link.hpp
//                 0x82 a set-point came: number 0..3, 1: valid, value (u16)
//                 0x83 bytes that the GPS was told: when the pod tells it (u32, us), at most 44
//                 0x84 bytes that the radio was told, likewise
//   Bytes         integers low byte first
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "firmware/link/crc16.hpp"

namespace fw::pod {

inline constexpr std::uint8_t kFrameStart = 0xA5;
inline constexpr std::size_t kFrameHead = 4, kFrameTail = 2, kMostPayload = 56;
enum class FrameKind : std::uint8_t {
  sample = 0x01,
  faults = 0x02,
  barometer = 0x03,
  prom = 0x04,
  magnetometer = 0x05,
  esc = 0x06,
  gps = 0x07,
  gps_baud = 0x08,
  sbus = 0x09,
  cppm = 0x0A,
  radio = 0x0B,
  radio_baud = 0x0C,
  battery = 0x0D,
  status = 0x81,
  setpoint = 0x82,
  gps_written = 0x83,
  radio_written = 0x84,
};

struct Frame {
  FrameKind kind{};
  std::uint8_t sequence = 0, length = 0;
  std::array<std::uint8_t, kMostPayload> payload{};
  std::int16_t word(std::size_t at) const {
    return static_cast<std::int16_t>(payload[at] | payload[at + 1] << 8);
  }
  std::uint16_t half(std::size_t at) const { return static_cast<std::uint16_t>(word(at)); }
  std::uint32_t whole(std::size_t at) const {
    return half(at) | static_cast<std::uint32_t>(half(at + 2)) << 16;
  }
  std::span<const std::uint8_t> bytes(std::size_t from) const {
    return std::span(payload).first(length).subspan(from);
  }
};

// Bytes in, frames out. What is no frame is skipped; a start whose CRC is wrong is counted.
class FrameReader {
 public:
  // True: frame() is new.
  bool add(std::uint8_t byte);
  const Frame& frame() const { return frame_; }
  std::uint32_t damaged() const { return damaged_; }

 private:
  std::size_t at_ = 0;  // bytes of the frame so far
  std::uint16_t crc_ = 0, told_ = 0;
  Frame frame_;
  std::uint32_t damaged_ = 0;
};

inline bool FrameReader::add(std::uint8_t byte) {
  const std::size_t at = at_++;
  if (at == 0) {
    crc_ = kCrcStart;
    if (byte != kFrameStart) at_ = 0;
    return false;
  }
  if (at < kFrameHead + frame_.length || at < kFrameHead) crc_ = crc_add(crc_, byte);
  if (at == 1) {
    frame_.kind = static_cast<FrameKind>(byte);
    frame_.length = 0;
  } else if (at == 2) {
    frame_.sequence = byte;
  } else if (at == 3) {
    frame_.length = byte;
    if (byte > kMostPayload) {
      ++damaged_;
      at_ = 0;
    }
  } else if (at < kFrameHead + frame_.length) {
    frame_.payload[at - kFrameHead] = byte;
  } else if (at == kFrameHead + frame_.length) {
    told_ = byte;
  } else {
    at_ = 0;
    told_ = static_cast<std::uint16_t>(told_ | byte << 8);
    if (told_ == crc_) return true;
    ++damaged_;
  }
  return false;
}

// Appends to a frame's payload.
class FrameWriter {
 public:
  FrameWriter(FrameKind kind, std::uint8_t sequence) {
    bytes_ = {kFrameStart, static_cast<std::uint8_t>(kind), sequence, 0};
  }
  void byte(std::uint32_t value) { bytes_[size_++] = static_cast<std::uint8_t>(value); }
  void half(std::uint32_t value) {
    byte(value & 0xFF);
    byte(value >> 8 & 0xFF);
  }
  void word(std::uint32_t value) {
    half(value & 0xFFFF);
    half(value >> 16);
  }
  FrameKind kind() const { return static_cast<FrameKind>(bytes_[1]); }
  std::uint8_t sequence() const { return bytes_[2]; }
  std::span<const std::uint8_t> payload() const {
    return std::span(bytes_).first(size_).subspan(kFrameHead);
  }
  std::span<const std::uint8_t> finish() {
    bytes_[3] = static_cast<std::uint8_t>(size_ - kFrameHead);
    std::uint16_t crc = kCrcStart;
    for (std::size_t i = 1; i < size_; ++i) crc = crc_add(crc, bytes_[i]);
    half(crc);
    return {bytes_.data(), size_};
  }

 private:
  std::array<std::uint8_t, kFrameHead + kMostPayload + kFrameTail> bytes_{};
  std::size_t size_ = kFrameHead;
};

}  // namespace fw::pod
