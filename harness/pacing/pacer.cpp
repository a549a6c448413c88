#include "harness/pacing/pacer.hpp"

#include <algorithm>
#include <cmath>

#include "base/check.hpp"

namespace whirl::pacing {
Pacer::Pacer(HostClock& clock, double pace, std::int64_t late_ns)
    : clock_(clock), pace_(pace), late_ns_(late_ns) {
  WHIRL_CHECK(std::isfinite(pace) && pace > 0.0, pace);
}

std::int64_t Pacer::due_ns(std::int64_t t_ns) {
  const auto due_after_ns = std::llround(static_cast<double>(t_ns) / pace_);
  if (!anchored_) {
    anchored_ = true;
    anchor_ns_ = clock_.now_ns() - due_after_ns;
  }
  return anchor_ns_ + due_after_ns;
}

void Pacer::wait_for(std::int64_t t_ns) {
  const std::int64_t due = due_ns(t_ns);
  if (clock_.now_ns() < due) clock_.sleep_until(due);
  begun(t_ns);
}

void Pacer::begun(std::int64_t t_ns) {
  const std::int64_t behind_ns = std::max<std::int64_t>(0, clock_.now_ns() - due_ns(t_ns));
  ++lateness_.steps;
  lateness_.latest_ns = behind_ns;
  lateness_.worst_ns = std::max(lateness_.worst_ns, behind_ns);
  if (behind_ns > late_ns_) ++lateness_.late_steps;
  if (behind_ns <= kCatchUp_ns) return;
  anchor_ns_ += behind_ns;
  lateness_.slipped_ns += behind_ns;
}

std::int64_t Pacer::virtual_ns(std::int64_t host_ns) const {
  WHIRL_CHECK(anchored_);
  return std::llround(static_cast<double>(host_ns - anchor_ns_) * pace_);
}

}  // namespace whirl::pacing
