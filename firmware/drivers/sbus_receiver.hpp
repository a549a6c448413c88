// A radio-control receiver on SBUS, from the bytes of a UART of 100000 baud, 8E2. The line is inverted:
// an STM32F4 needs an inverter before its pin.
//
//   Contract  push() with each byte, its time and whether the UART saw an error in it (parity, framing,
//             noise, overrun)
//   Frame     begins behind a pause of 1 ms; 25 bytes, the first 0F. The last byte is not judged: its values
//             differ from receiver to receiver. A byte with an error spoils its frame
//   Lost      100 ms without a frame; a frame that says failsafe counts, and says so
//   Source    PX4 sbus.c, Betaflight rx/sbus.c, bolderflight/sbus: they agree
//   Left out  channels 17 and 18. There is no checksum: what parity misses the caller must find implausible
#pragma once
#include <array>
#include <cstdint>

#include "firmware/status.hpp"

namespace fw {

struct SbusFrame {
  std::array<std::uint16_t, 16> channels{};  // 172..1811 from stop to stop, 992 centred
  bool frame_lost = false, failsafe = false;
  std::uint32_t received_us = 0;

  // It tells where the sticks are; else where they were, or what the receiver is set up to put out.
  bool is_news() const { return !frame_lost && !failsafe; }
  // As a servo's pulse: 5/8 us a count, 880 us at 0.
  std::uint32_t pulse_us(unsigned channel) const {
    return (channels[channel] * 5u + 4u) / 8u + 880u;
  }
  std::array<std::uint16_t, 16> pulses_us() const {
    std::array<std::uint16_t, 16> out{};
    for (unsigned i = 0; i < out.size(); ++i) out[i] = static_cast<std::uint16_t>(pulse_us(i));
    return out;
  }
};

class SbusReceiver {
 public:
  // True: frame() is new.
  bool push(std::uint8_t byte, std::uint32_t now_us, bool error = false) {
    if (now_us - last_us_ > kPause_us) have_ = 0;
    last_us_ = now_us;
    if (have_ == kBroken) return false;
    if (error || (have_ == 0 && byte != 0x0F)) {
      have_ = kBroken;
      bad_frames_ = bad_frames_ + 1;
      return false;
    }
    bytes_[have_++] = byte;
    if (have_ < kLength) return false;
    have_ = kBroken;  // until the next pause
    heard_ = true;
    unpack(now_us);
    return true;
  }
  const SbusFrame& frame() const { return frame_; }
  Status status(std::uint32_t now_us) const {
    return heard_ && now_us - frame_.received_us < kLost_us ? Status::ok : Status::no_answer;
  }
  std::uint32_t bad_frames() const { return bad_frames_; }

 private:
  static constexpr std::size_t kLength = 25, kBroken = 26;
  static constexpr std::uint32_t kPause_us = 1000, kLost_us = 100'000;

  void unpack(std::uint32_t now_us) {
    for (std::size_t channel = 0; channel < frame_.channels.size(); ++channel) {
      const std::size_t bit = channel * 11, at = 1 + bit / 8;
      const std::uint32_t word = bytes_[at] | static_cast<std::uint32_t>(bytes_[at + 1]) << 8 |
                                 static_cast<std::uint32_t>(bytes_[at + 2])
                                     << 16;  // at most the flags: never beyond
      frame_.channels[channel] = static_cast<std::uint16_t>(word >> bit % 8 & 0x7FF);
    }
    frame_.frame_lost = (bytes_[23] & 0x04) != 0;
    frame_.failsafe = (bytes_[23] & 0x08) != 0;
    frame_.received_us = now_us;
  }

  std::array<std::uint8_t, kLength> bytes_{};
  std::size_t have_ = kBroken;  // nothing before the first pause
  std::uint32_t last_us_ = 0, bad_frames_ = 0;
  bool heard_ = false;
  SbusFrame frame_;
};

}  // namespace fw
