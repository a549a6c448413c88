// One clock of the host for two threads of a test: it stands while either of them is at work, and goes on to the earliest
// time that is waited for when both wait. Nobody is late, however slow the machine and whatever else runs on it.
//
//   Files   wake nobody early: what has come is found when the time is over
//   Left    a thread that is done leaves; the other one's waits then take no time
#pragma once
#include <algorithm>
#include <condition_variable>
#include <limits>
#include <mutex>

#include "harness/pacing/host_clock.hpp"

namespace whirl {

class CommonClock final : public pacing::HostClock {
 public:
  std::int64_t now_ns() const override {
    const std::scoped_lock lock(mutex_);
    return now_ns_;
  }
  void sleep_until(std::int64_t t_ns) override {
    std::unique_lock lock(mutex_);
    if (t_ns <= now_ns_) return;
    if (others_ == 0) {
      now_ns_ = t_ns;
    } else if (first_ns_ == kNobody) {
      first_ns_ = t_ns;
      wait(lock, t_ns);
    } else {
      now_ns_ = std::min(t_ns, first_ns_);
      wake_first();
      if (t_ns <= now_ns_) return;
      first_ns_ = t_ns;
      wait(lock, t_ns);
    }
  }
  void wait_for(std::span<pollfd> /*files*/, std::int64_t t_ns) override { sleep_until(t_ns); }
  void leave() {
    const std::scoped_lock lock(mutex_);
    others_ = 0;
    if (first_ns_ == kNobody) return;
    now_ns_ = std::max(now_ns_, first_ns_);
    wake_first();
  }

 private:
  static constexpr std::int64_t kNobody = std::numeric_limits<std::int64_t>::max();

  // Pre: this thread is the one that waits for first_ns_.
  void wait(std::unique_lock<std::mutex>& lock, std::int64_t t_ns) {
    moved_.wait(lock, [&] { return now_ns_ >= t_ns; });
  }
  // Whoever waits for a time that has come.
  void wake_first() {
    if (first_ns_ > now_ns_) return;
    first_ns_ = kNobody;
    moved_.notify_all();
  }

  mutable std::mutex mutex_;
  std::condition_variable moved_;
  std::int64_t now_ns_ = 1'000'000'000, first_ns_ = kNobody;
  int others_ = 1;
};

}  // namespace whirl
