#include "harness/lockstep/lockstep.hpp"

#include <optional>

#include "base/stopwatch.hpp"

namespace whirl {

Result<Done> Lockstep::start() {
  if (auto started = target_.start(); !started) return started;
  world_.step(0, happened_, sensed_);
  world_.read(row_);
  return Done{};
}

Result<TargetState> Lockstep::step(const std::function<void(const io::Batch&)>& sent) {
  const std::int64_t next_ns = now_ns_ + kLockstep_ns;
  target_.run(next_ns, sensed_);
  if (sent) sent(sensed_);
  {
    const Stopwatch watch(times_.world_s);
    sensed_.clear();
    world_.step(next_ns, happened_, sensed_);
  }
  happened_.clear();
  std::optional<Result<TargetState>> arrived;
  {
    const Stopwatch watch(times_.target_wait_s);
    arrived = target_.arrive(happened_);
  }
  if (!*arrived) return *arrived;
  now_ns_ = next_ns;
  world_.read(row_);
  return *arrived;
}

void Lockstep::stop() {
  happened_.clear();
  target_.stop(happened_);
}

}  // namespace whirl
