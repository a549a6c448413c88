#include "harness/flight/zero_crossings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "harness/base/check.hpp"

namespace whirl::flight {
namespace {

constexpr double kTick_ns = 500.0;

}  // namespace

void ZeroCrossings::note(std::int64_t tick) {
  newest_ = (newest_ + 1) % (kSectors + 1);
  ticks_[static_cast<std::size_t>(newest_)] = tick;
  seen_ = std::min(seen_ + 1, kSectors + 1);
}

void ZeroCrossings::turn(std::int64_t from_ns, std::int64_t to_ns, double from_radps,
                         double to_radps) {
  WHIRL_CHECK(to_ns > from_ns, from_ns, to_ns);
  const double rate_pns =
      0.5 * (from_radps + to_radps) * 1e-9 * pole_pairs_ * kSectors / (2.0 * std::numbers::pi);
  const double turned = sectors_ + std::max(0.0, rate_pns) * static_cast<double>(to_ns - from_ns);
  for (double sector = 1.0; sector <= turned; sector += 1.0) {
    const double at_ns = static_cast<double>(from_ns) + (sector - sectors_) / rate_pns;
    note(std::llround(at_ns / kTick_ns));
  }
  sectors_ = turned - std::floor(turned);
  if (!in_sync()) return;
  const double silent = static_cast<double>(to_ns) / kTick_ns - static_cast<double>(newest());
  if (silent > 9.0 / kSectors * static_cast<double>(newest() - oldest())) restart();
}

double ZeroCrossings::speed_radps() const {
  if (!in_sync()) return 0.0;
  const double revolution_s = static_cast<double>(newest() - oldest()) * kTick_ns * 1e-9;
  return 2.0 * std::numbers::pi / (revolution_s * pole_pairs_);
}

}  // namespace whirl::flight
