// The edges of one clock on the virtual time axis, exact and without drift.
//
//   Edge k    is at origin + ceil(k * 1e9 / f) nanoseconds; f is a whole number of hertz
//   Law       ticks(time(k)) == k for f < 1 GHz
//   Change    set_frequency() keeps the count of edges and starts a new origin
#pragma once
#include <cmath>
#include <cstdint>

#include "io_bridges/devices/event_queue.hpp"

namespace whirl::stm32 {

class TickGrid {
 public:
  void set_frequency(double frequency_Hz, io::Nanoseconds now) {
    const std::int64_t whole_Hz = std::llround(frequency_Hz);
    if (whole_Hz == frequency_Hz_) return;
    first_ = ticks(now);
    origin_ = now;
    frequency_Hz_ = whole_Hz;
  }

  // The number of the last edge at or before t.
  std::int64_t ticks(io::Nanoseconds t) const {
    const std::int64_t dt = t - origin_;
    return first_ + dt / kSecond * frequency_Hz_ + dt % kSecond * frequency_Hz_ / kSecond;
  }
  io::Nanoseconds time(std::int64_t tick) const {
    const std::int64_t n = tick - first_;
    if (frequency_Hz_ <= 0) return n <= 0 ? origin_ : io::kNever;
    if (n < 0)
      return origin_ - -n / frequency_Hz_ * kSecond - -n % frequency_Hz_ * kSecond / frequency_Hz_;
    const std::int64_t seconds = n / frequency_Hz_;
    if (seconds > kLongest_s) return io::kNever;
    const std::int64_t rest = n % frequency_Hz_;
    return origin_ + seconds * kSecond + (rest * kSecond + frequency_Hz_ - 1) / frequency_Hz_;
  }
  // The number of the first edge at or after t.
  std::int64_t next_tick(io::Nanoseconds t) const {
    const std::int64_t last = ticks(t);
    return time(last) == t ? last : last + 1;
  }
  std::int64_t frequency_Hz() const { return frequency_Hz_; }

 private:
  static constexpr std::int64_t kSecond = 1'000'000'000;
  static constexpr std::int64_t kLongest_s = 100'000'000;  // three years

  std::int64_t frequency_Hz_ = 0;
  std::int64_t first_ = 0;
  io::Nanoseconds origin_ = 0;
};

}  // namespace whirl::stm32
