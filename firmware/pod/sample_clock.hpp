// When a sample is due that its host has stamped: as evenly as the stamps are, however unevenly samples come. The pod's
// clock is held to the host's by how early samples come: of each second the latest is to be kGuard_us early.
//
//   Delay    of data-ready behind the fastest way that a sample takes: what the slowest of the last seconds took longer, and
//            kGuard_us; at most kMost_us
//   Even     with a sample the clock moves by at most 4 us towards later and by 1 us towards earlier: 0.4 %, where
//            the part's own clock may be off by 1 %
//   Late     a sample that comes after it is due is shown at once, and is no data-ready of its time
//   Bound    no sample waits longer than kMost_us: the clock is set back at once
//   Anew     at the start, after a pause, and when kRow in a row came kMost_us late: the one at hand is due kGuard_us later.
//            In the window that follows one that comes late moves the clock at once, for the way's spread is not known yet
#pragma once
#include <algorithm>
#include <cstdint>

namespace fw::pod {

class SampleClock {
 public:
  static constexpr std::int32_t kGuard_us = 100, kMost_us = 3000, kLate_us = 20,
                                kUnsettled_us = 250;
  static constexpr std::uint32_t kWindow = 1000 /* samples */, kPause_us = 20'000, kRow = 50;

  struct Place {
    std::uint32_t due_us = 0;
    bool late = false;
  };

  // Of the sample that came now. stamp_us: the host's time of it, which wraps.
  Place place(std::uint16_t stamp_us, std::uint32_t now_us);
  // Of the last whole window: the longest that a sample waited for its time.
  std::uint32_t longest_wait_us() const { return longest_wait_us_; }

 private:
  static constexpr std::int32_t kNone = 1 << 20, kLater_us = 4, kEarlier_us = -1;

  void begin(std::uint32_t now_us);
  void follow(std::int32_t early_us);
  void move(std::int32_t by_us);

  bool begun_ = false;
  std::uint16_t stamp_us_ = 0;
  std::uint32_t due_us_ = 0, came_us_ = 0;
  std::uint32_t row_ = 0;   // samples that came too late for the clock
  std::uint32_t seen_ = 0;  // in this window
  bool settled_ = false;    // it is not the first one
  std::int32_t least_us_ = kNone,
               most_us_ = -kNone;  // early, in this window, by the clock as it is now
  std::int32_t to_move_us_ = 0;
  std::uint32_t longest_wait_us_ = 0;
};

inline SampleClock::Place SampleClock::place(std::uint16_t stamp_us, std::uint32_t now_us) {
  due_us_ += static_cast<std::uint16_t>(stamp_us - stamp_us_);
  stamp_us_ = stamp_us;
  const bool paused = begun_ && now_us - came_us_ > kPause_us;
  came_us_ = now_us;
  auto early_us = static_cast<std::int32_t>(due_us_ - now_us);
  row_ = early_us < -kMost_us ? row_ + 1 : 0;
  if (!begun_ || paused || row_ == kRow) {
    const bool late = begun_;
    begin(now_us);
    return {due_us_, late};
  }
  const bool late = early_us < -(settled_ ? kLate_us : kUnsettled_us);
  if (!settled_ && early_us < 0) move(-early_us);
  if (early_us > kMost_us) move(kMost_us - early_us);
  const Place place{due_us_, late};
  early_us = static_cast<std::int32_t>(due_us_ - now_us);
  follow(early_us);
  return place;
}

inline void SampleClock::begin(std::uint32_t now_us) {
  begun_ = true;
  settled_ = false;
  due_us_ = now_us + kGuard_us;
  seen_ = row_ = 0;
  least_us_ = kNone;
  most_us_ = -kNone;
  to_move_us_ = 0;
}

inline void SampleClock::follow(std::int32_t early_us) {
  least_us_ = std::min(least_us_, early_us);
  most_us_ = std::max(most_us_, early_us);
  const bool whole = ++seen_ == kWindow;
  const std::int32_t wanted_us = std::min(kGuard_us - least_us_, kMost_us - most_us_);
  if (wanted_us > 0 || whole) to_move_us_ = wanted_us;
  if (whole) {
    longest_wait_us_ = static_cast<std::uint32_t>(std::max(most_us_, std::int32_t{0}));
    settled_ = true;
    seen_ = 0;
    least_us_ = kNone;
    most_us_ = -kNone;
  }
  const std::int32_t by_us = std::clamp(to_move_us_, kEarlier_us, kLater_us);
  to_move_us_ -= by_us;
  move(by_us);
}

inline void SampleClock::move(std::int32_t by_us) {
  due_us_ += static_cast<std::uint32_t>(by_us);
  least_us_ += by_us;
  most_us_ += by_us;
}

}  // namespace fw::pod
