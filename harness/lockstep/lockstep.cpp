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
    const io::Batch& happened = for_world();
    sensed_.clear();
    world_.step(next_ns, happened, sensed_);
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

// Of one board, as most runs are, nothing is copied.
const io::Batch& Lockstep::for_world() {
  bool others = false;
  for (io::Reader r(happened_.bytes()); !others && r.next();) others = r.header().board != 0;
  if (!others) return happened_;
  for_world_.clear();
  for (io::Reader r(happened_.bytes()); r.next();) {
    const io::Header& head = r.header();
    if (head.board == 0 || world_.hears(head)) for_world_.add(head, r.payload());
  }
  return for_world_;
}

void Lockstep::stop() {
  happened_.clear();
  target_.stop(happened_);
}

}  // namespace whirl
