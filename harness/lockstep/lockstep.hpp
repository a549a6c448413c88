// A world and a target in step, 1 ms at a time: the one loop that a plan's run and a bench share.
//
//   Step     the target runs (t_k, t_k+1] with what was sensed until t_k, while the world takes the
//            same step with what the target had done until t_k; then the target's deeds arrive and
//            the signals are read
//   Boards   the world surrounds the first one: it sees that one's messages only
//   Order    neither waits for what the other does within the step, so that host speed changes nothing
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "harness/target/target.hpp"
#include "harness/world/world.hpp"

namespace whirl {

inline constexpr std::int64_t kLockstep_ns = 1'000'000;

class Lockstep {
 public:
  struct HostTimes {  // for reports only
    double world_s = 0.0, target_wait_s = 0.0;
  };

  Lockstep(World& world, Target& target) : world_(world), target_(target) {
    row_.resize(world.signals().size());
  }
  Lockstep(const Lockstep&) = delete;
  Lockstep& operator=(const Lockstep&) = delete;

  // Errors  those of Target::start; then nothing has begun.
  Result<Done> start();
  // `sent` sees what the target was given, while it runs. An Error leaves the time where it was;
  // happened() holds what still arrived.
  Result<TargetState> step(const std::function<void(const io::Batch&)>& sent = nullptr);
  // Ends the target; happened() then holds its last words. Safe to call twice.
  void stop();

  std::int64_t now_ns() const { return now_ns_; }
  const std::vector<double>& row() const { return row_; }  // signals at now, as in world.signals()
  const io::Batch& happened() const { return happened_; }  // in the latest step
  io::Batch& to_send() { return sensed_; }                 // goes to the target with the next step
  const HostTimes& host_times() const { return times_; }

 private:
  // What the first board did in the latest step, and what the world hears of others.
  const io::Batch& for_world();

  World& world_;
  Target& target_;
  io::Batch sensed_, happened_, for_world_;
  std::vector<double> row_;
  std::int64_t now_ns_ = 0;
  HostTimes times_;
};

}  // namespace whirl
