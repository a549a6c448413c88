// A radio-control receiver's sum signal (CPPM), from the times of its edges.
//
//   Contract  edge() with the time of each edge of one kind (all rising, or all falling), in ticks of 1 MHz
//             that wrap at 32 bits; a capture register of 16 bits is widened by the caller
//   Limits    a channel is 800 to 2200 us long, a gap at least 2700 us; anything else spoils its frame. A
//             number of channels (5 to 16) counts once four frames in a row have had it
//   Lost      100 ms without a frame
//   Source    PX4 drv_hrt.c (limits, lock), ppm_decode.c (100 ms), Betaflight rx_pwm.c (gap as a whole)
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "firmware/status.hpp"

namespace fw {

struct CppmFrame {
  std::array<std::uint16_t, 16> channels_us{};
  std::uint8_t count = 0;
  std::uint32_t received_us = 0;  // the edge that ended its last channel

  std::span<const std::uint16_t> channels() const { return {channels_us.data(), count}; }
};

class CppmReceiver {
 public:
  // True: frame() is new.
  bool edge(std::uint32_t now_us) {
    const std::uint32_t width_us = now_us - last_us_;
    last_us_ = now_us;
    if (width_us >= kGap_us) return end_of_gap();
    if (!in_frame_) return false;
    if (width_us < kShortest_us || width_us > kLongest_us || count_ == kMost) return spoil();
    widths_us_[count_++] = static_cast<std::uint16_t>(width_us);
    end_us_ = now_us;
    return false;
  }
  const CppmFrame& frame() const { return frame_; }
  // ok, or no_answer: never locked, or lost since.
  Status status(std::uint32_t now_us) const {
    const bool heard = frame_.count != 0 && now_us - frame_.received_us < kLost_us;
    return heard ? Status::ok : Status::no_answer;
  }
  std::uint32_t bad_intervals() const { return bad_intervals_; }

 private:
  static constexpr std::uint32_t kShortest_us = 800, kLongest_us = 2200, kGap_us = 2700;
  static constexpr std::uint32_t kLost_us = 100'000;
  static constexpr std::uint8_t kFewest = 5, kMost = 16, kSame_frames = 4;

  // The channels before the gap are a frame, if they were counted from a gap on.
  bool end_of_gap() {
    const std::uint8_t count = in_frame_ ? count_ : std::uint8_t{0};
    in_frame_ = true;
    count_ = 0;
    if (count < kFewest || !expected(count)) return false;
    frame_ = {widths_us_, count, end_us_};
    return true;
  }
  bool expected(std::uint8_t count) {
    if (count == expected_count_) {
      same_frames_ = 0;
      return true;
    }
    same_frames_ = count == other_count_ ? same_frames_ : std::uint8_t{0};
    other_count_ = count;
    if (++same_frames_ < kSame_frames) return false;
    expected_count_ = count;
    same_frames_ = 0;
    return true;
  }
  bool spoil() {
    in_frame_ = false;
    bad_intervals_ = bad_intervals_ + 1;
    return false;
  }

  CppmFrame frame_;
  std::array<std::uint16_t, 16> widths_us_{};
  std::uint32_t last_us_ = 0, end_us_ = 0, bad_intervals_ = 0;
  std::uint8_t count_ = 0, expected_count_ = 0, other_count_ = 0, same_frames_ = 0;
  bool in_frame_ = false;
};

}  // namespace fw
