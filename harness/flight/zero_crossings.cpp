#include "harness/flight/zero_crossings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/check.hpp"

namespace whirl::flight {
namespace {

constexpr double kTimerTick_ns = 500.0;
constexpr std::int64_t kLongest_ticks = 0xFFFF;  // of a sector: the timer has 16 bits

std::int64_t tick_at(std::int64_t t_ns) {
  return std::llround(static_cast<double>(t_ns) / kTimerTick_ns);
}

}  // namespace

ZeroCrossings::ZeroCrossings(int pole_pairs) {
  config_.pole_pairs = static_cast<std::uint8_t>(pole_pairs);
}

void ZeroCrossings::restart() {
  seen_ = 0;
  since_ns_ = now_ns_;
  lengths_.fill(0);
}

void ZeroCrossings::record(std::int64_t at_ns) {
  const std::int64_t tick = tick_at(at_ns);
  if (seen_ > 0) {
    lengths_[next_] = static_cast<fw::esc::Ticks>(std::min(tick - crossed_tick_, kLongest_ticks));
    next_ = static_cast<std::uint8_t>((next_ + 1) % 6);
  }
  crossed_tick_ = tick;
  since_ns_ = at_ns;
  seen_ = std::min(seen_ + 1, 7);
}

void ZeroCrossings::turn(std::int64_t from_ns, std::int64_t to_ns, double from_radps,
                         double to_radps) {
  WHIRL_CHECK(to_ns > from_ns, from_ns, to_ns);
  now_ns_ = to_ns;
  const double rate_pns =
      0.5 * (from_radps + to_radps) * 1e-9 * config_.pole_pairs * 6.0 / (2.0 * std::numbers::pi);
  const double turned = sectors_ + std::max(0.0, rate_pns) * static_cast<double>(to_ns - from_ns);
  for (double sector = 1.0; sector <= turned; sector += 1.0) {
    record(from_ns + std::llround((sector - sectors_) / rate_pns));
  }
  sectors_ = turned - std::floor(turned);
  if (in_sync() && ticks_since_crossing() * 6 > 9 * std::int64_t{pace().revolution}) restart();
}

std::int64_t ZeroCrossings::ticks_since_crossing() const {
  return tick_at(now_ns_) - crossed_tick_;
}

fw::esc::Pace ZeroCrossings::pace() const {
  if (!in_sync()) return {};
  return fw::esc::pace_of(lengths_, next_, static_cast<std::uint32_t>(ticks_since_crossing()));
}

float ZeroCrossings::radps(std::uint32_t ticks, unsigned sectors) const {
  return fw::esc::Pace::radps(ticks, static_cast<float>(sectors), config_.one_radps());
}

}  // namespace whirl::flight
