// What a pod puts out for a GPS and a receiver, held against what its host gave it: each content once and in
// order, and the times of its edges and characters.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <span>
#include <vector>

#include "io_bridges/devices/bus.hpp"
#include "io_bridges/devices/core/receiver.hpp"

namespace whirl::rack {

using io::Nanoseconds;

// Lowest and highest of what takes time.
struct PodTimes {
  std::uint64_t count = 0;
  Nanoseconds least_ns = 0, most_ns = 0;
  void add(Nanoseconds ns) {
    least_ns = count == 0 ? ns : std::min(least_ns, ns);
    most_ns = count == 0 ? ns : std::max(most_ns, ns);
    ++count;
  }
};

// SBUS: the format, frames of 25 characters behind one another, their distance.
class SbusCheck {
 public:
  using Frame = std::array<std::uint8_t, core::receiver::kSbusBytes>;

  void told(const Frame& frame) {
    told_[1] = told_[0];
    told_[0] = frame;
  }
  void add(const io::UartByte& byte, const io::UartFormat& format, Nanoseconds now) {
    const bool right = std::abs(format.baud - core::receiver::kSbusBaud) < 1.0 &&
                       format.data_bits == 8 && format.parity == 'E' &&
                       std::abs(format.stop_bits - 2.0) < 0.1;
    if (!right) ++wrong_format;
    if (now - last_ns_ > kPause_ns) {
      if (size_ != 0) ++wrong;  // the one before was cut short
      size_ = 0;
      if (began_ns_ >= 0) period.add(now - began_ns_);
      began_ns_ = now;
    } else if (size_ != 0) {
      character.add(now - last_ns_);
    }
    last_ns_ = now;
    if (size_ < frame_.size()) frame_[size_] = byte.value;
    if (++size_ != frame_.size()) return;
    ++frames;
    if (frame_ != told_[0] && frame_ != told_[1]) ++wrong;
    size_ = 0;
  }

  std::uint64_t frames = 0, wrong = 0, wrong_format = 0;
  PodTimes period, character;

 private:
  static constexpr Nanoseconds kPause_ns = 1'000'000;
  std::array<Frame, 2> told_{};  // the newest, and the one that may have been under way
  Frame frame_{};
  std::size_t size_ = 0;
  Nanoseconds last_ns_ = -kPause_ns - 1, began_ns_ = -1;
};

// CPPM: from rising edge to rising edge.
class CppmCheck {
 public:
  using Lengths = std::vector<std::uint16_t>;  // steps of 0.5 us

  void told(const Lengths& lengths) {
    std::move_backward(told_.begin(), told_.end() - 1, told_.end());
    told_.front() = lengths;
  }
  void edge(bool level, Nanoseconds now) {
    if (!level) return pulse.add(now - rose_ns_);
    const Nanoseconds interval_ns = now - rose_ns_;
    const bool first = rose_ns_ < 0;
    rose_ns_ = now;
    if (first) return;
    if (interval_ns < kShortestGap_ns) return lengths_.push_back(interval_ns);
    if (begun_) judge(interval_ns);
    begun_ = true;
    lengths_.clear();
  }

  std::uint64_t frames = 0, wrong = 0;
  Nanoseconds most_off_ns = 0;  // of a channel's length, of the told one
  PodTimes pulse, frame;

 private:
  static constexpr Nanoseconds kShortestGap_ns = 3'000'000;

  void judge(Nanoseconds gap_ns) {
    ++frames;
    Nanoseconds sum_ns = gap_ns;
    for (const Nanoseconds ns : lengths_) sum_ns += ns;
    frame.add(sum_ns);
    Nanoseconds off_ns = io::kNever;
    for (const Lengths& lengths : told_) off_ns = std::min(off_ns, off(lengths));
    if (off_ns >= core::receiver::kCppmStep_ns) return void(++wrong);
    most_off_ns = std::max(most_off_ns, off_ns);
  }
  Nanoseconds off(const Lengths& lengths) const {
    if (lengths.size() != lengths_.size()) return io::kNever;
    Nanoseconds most_ns = 0;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      most_ns =
          std::max(most_ns, std::abs(lengths_[i] - lengths[i] * core::receiver::kCppmStep_ns));
    }
    return most_ns;
  }

  // A frame is judged when the one after it begins; it was taken over before it began.
  std::array<Lengths, 4> told_;
  std::vector<Nanoseconds> lengths_;
  Nanoseconds rose_ns_ = -1;
  bool begun_ = false;
};

// A line whose bytes were given before: the same, in order, at their rates, and how long after.
class GpsCheck {
 public:
  void given(std::uint8_t byte, double baud, Nanoseconds now) {
    given_.push_back({byte, baud, now});
  }
  void add(std::uint8_t byte, double baud, Nanoseconds now) {
    ++bytes;
    if (given_.empty() || given_.front().value != byte) return void(++wrong);
    delay.add(now - given_.front().given_ns);
    if (std::abs(baud / given_.front().baud - 1.0) > 0.005) ++off_rate;
    given_.pop_front();
  }
  std::size_t missing() const { return given_.size(); }

  std::uint64_t bytes = 0, wrong = 0, off_rate = 0;
  PodTimes delay;

 private:
  struct Given {
    std::uint8_t value = 0;
    double baud = 0.0;
    Nanoseconds given_ns = 0;
  };
  std::deque<Given> given_;
};

}  // namespace whirl::rack
