// Holds virtual time to the host's clock: virtual time t is due at anchor + t / pace.
//
//   Deadlines absolute, so that the lateness of one step is made up by those that follow
//   Late      what is less than kCatchUp_ns behind is made up. Whatever is more is given up: the anchor
//             moves, virtual time goes on at its pace from there, and slipped_ns() says how much the run
//             has lost on the host's clock. No step is left out, and none is hurried through
//   Verdicts  nothing here enters them
#pragma once
#include <cstdint>

#include "harness/pacing/host_clock.hpp"

namespace whirl::pacing {

inline constexpr std::int64_t kCatchUp_ns = 100'000'000;  // of the host

struct Lateness {
  std::int64_t steps = 0, late_steps = 0;    // late: by more than the pacer's late_ns
  std::int64_t latest_ns = 0, worst_ns = 0;  // of a step, behind its deadline
  std::int64_t slipped_ns = 0;               // given up, in sum
};

class Pacer {
 public:
  // pace: virtual seconds to a second of the host, above 0. The anchor is set by the first wait.
  Pacer(HostClock& clock, double pace, std::int64_t late_ns = 1'000'000);

  // Sleeps until virtual time t_ns is due. In order of time.
  void wait_for(std::int64_t t_ns);
  // The same, where somebody else waits (for what comes in): when it is due, and that it has begun.
  std::int64_t due_ns(std::int64_t t_ns);
  void begun(std::int64_t t_ns);
  // The virtual time of one of the host's. Pre: a wait has set the anchor.
  std::int64_t virtual_ns(std::int64_t host_ns) const;
  const Lateness& lateness() const { return lateness_; }
  void count_anew() { lateness_ = {}; }  // what was late so far does not matter

 private:
  HostClock& clock_;
  double pace_;
  std::int64_t late_ns_;
  bool anchored_ = false;
  std::int64_t anchor_ns_ = 0;
  Lateness lateness_;
};

}  // namespace whirl::pacing
