// How long to look for the other side's answer before the kernel is asked to wake us: as long as a core
// is free for it, not at all where looking takes that core from somebody.
//
//   Signal   a thread that is taken off its core against its will (ru_nivcsw) has shown that somebody
//            else wants one
//   Unit     turns of a loop with a pause in it, about 25 ns each
//   Measured two jobs on two cores take 38 s with at least 3000 turns, 22 s with 400, 21 s with 100
#pragma once
#include <algorithm>

namespace whirl::io {

class SpinPolicy {
 public:
  static constexpr int kLeast = 100, kMost = 40'000;
  static constexpr int kHeld_back = 200;  // waits after a sign of load

  explicit SpinPolicy(int cores) : alone_(cores < 2) {}

  int turns() const { return alone_ ? 0 : turns_; }

  // After each wait: how often this thread has been taken off its core so far, in its whole life.
  void waited(long preemptions) {
    const bool wanted = preemptions != preemptions_;
    preemptions_ = preemptions;
    if (wanted) {
      turns_ = kLeast;
      held_back_ = kHeld_back;
    } else if (held_back_ > 0) {
      --held_back_;
    } else {
      turns_ = std::min(kMost, 2 * turns_);
    }
  }

 private:
  bool alone_;
  int turns_ = kLeast;
  int held_back_ = 0;
  long preemptions_ = 0;
};

}  // namespace whirl::io
