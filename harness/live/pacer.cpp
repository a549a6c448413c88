#include "harness/live/pacer.hpp"

#include <algorithm>
#include <cmath>

#include "base/check.hpp"

namespace whirl::live {
namespace {

constexpr std::int64_t kLate_ns = 1'000'000;

}  // namespace

Pacer::Pacer(HostClock& clock, double pace) : clock_(clock), pace_(pace) {
  WHIRL_CHECK(std::isfinite(pace) && pace > 0.0, pace);
}

void Pacer::wait_for(std::int64_t t_ns) {
  const auto due_after_ns = std::llround(static_cast<double>(t_ns) / pace_);
  if (!anchored_) {
    anchored_ = true;
    anchor_ns_ = clock_.now_ns() - due_after_ns;
  }
  const std::int64_t due_ns = anchor_ns_ + due_after_ns;
  if (clock_.now_ns() < due_ns) clock_.sleep_until(due_ns);
  const std::int64_t late_ns = std::max<std::int64_t>(0, clock_.now_ns() - due_ns);
  ++lateness_.steps;
  lateness_.latest_ns = late_ns;
  lateness_.worst_ns = std::max(lateness_.worst_ns, late_ns);
  if (late_ns > kLate_ns) ++lateness_.late_steps;
  if (late_ns <= kCatchUp_ns) return;
  anchor_ns_ += late_ns;
  lateness_.slipped_ns += late_ns;
}

}  // namespace whirl::live
