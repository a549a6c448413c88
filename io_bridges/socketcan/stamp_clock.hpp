// A controller's own time stamps on the host's clock.
//
//   Method  what a frame takes from the controller to the kernel is never negative, and sometimes nearly nothing: the
//           host's time of a stamp is the stamp plus the least difference that was seen in the last 10 to 20 s
//   Valid   the two clocks drift apart by less than 100 ppm: the error grows by 2 ms at most between two windows. A
//           stamp that jumps back, or by more than a second against the host, starts anew
//   Error   the least delay there is, which no stamp shows
#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>

namespace whirl::io {

class StampClock {
 public:
  // The host's time of a stamp; seen_ns: when the kernel saw the frame, never earlier than the answer.
  std::int64_t host_ns(std::int64_t stamp_ns, std::int64_t seen_ns) {
    const std::int64_t difference = seen_ns - stamp_ns;
    const std::int64_t known = std::min(least_, before_);
    if (stamp_ns < last_stamp_ns_ || (known != kNone && difference < known - kJump_ns)) {
      least_ = before_ = kNone;
    }
    last_stamp_ns_ = stamp_ns;
    if (seen_ns - window_ns_ > kWindow_ns) {
      before_ = least_;
      least_ = kNone;
      window_ns_ = seen_ns;
    }
    least_ = std::min(least_, difference);
    return stamp_ns + std::min(least_, before_);
  }

 private:
  static constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::max();
  static constexpr std::int64_t kWindow_ns = 10'000'000'000;
  static constexpr std::int64_t kJump_ns = 1'000'000'000;
  std::int64_t least_ = kNone, before_ = kNone;  // differences of this window and the one before
  std::int64_t window_ns_ = 0;
  std::int64_t last_stamp_ns_ = std::numeric_limits<std::int64_t>::min();
};

}  // namespace whirl::io
