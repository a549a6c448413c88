// One clock of the host for two threads of a test. One of them works at a time, and the clock stands meanwhile; when both
// wait, it goes to the earlier of the times that they wait for, and that one works on: the thread that made the clock,
// where both are due at once. So nobody is late, and what comes of it is the same on any machine, whatever else runs.
//
//   Files   wake nobody early: what has come is found when the time is over
//   Left    a thread that is done leaves; the other one's waits then take no time
//   Begin   where a link watches over its heartbeat by the host's own clock, begin far ahead of that one: it is never lost then
#pragma once
#include <array>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <thread>

#include "harness/pacing/host_clock.hpp"

namespace whirl {

class CommonClock final : public pacing::HostClock {
 public:
  explicit CommonClock(std::int64_t begin_ns = 1'000'000'000) : now_ns_(begin_ns) {}
  std::int64_t now_ns() const override {
    const std::scoped_lock lock(mutex_);
    return now_ns_;
  }
  void sleep_until(std::int64_t t_ns) override {
    std::unique_lock lock(mutex_);
    if (t_ns <= now_ns_) return;
    const std::size_t own = std::this_thread::get_id() == maker_ ? 0 : 1;
    until_ns_[own] = t_ns;
    go_on();
    moved_.wait(lock, [&] { return until_ns_[own] == kWorks; });
  }
  void wait_for(std::span<pollfd> /*files*/, std::int64_t t_ns) override { sleep_until(t_ns); }
  // The maker's thread: it is done.
  void leave() {
    const std::scoped_lock lock(mutex_);
    until_ns_[0] = kNever;
    go_on();
  }

 private:
  static constexpr std::int64_t kWorks = -1, kNever = std::numeric_limits<std::int64_t>::max();

  // When neither works: the earlier one does.
  void go_on() {
    if (until_ns_[0] == kWorks || until_ns_[1] == kWorks) return;
    const std::size_t next = until_ns_[0] <= until_ns_[1] ? 0 : 1;
    now_ns_ = until_ns_[next];
    until_ns_[next] = kWorks;
    moved_.notify_all();
  }

  const std::thread::id maker_ = std::this_thread::get_id();
  mutable std::mutex mutex_;
  std::condition_variable moved_;
  std::int64_t now_ns_;
  std::array<std::int64_t, 2> until_ns_{kWorks, kWorks};
};

}  // namespace whirl
