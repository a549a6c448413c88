#include "io_bridges/openocd/pc_samples.hpp"

#include <algorithm>
#include <cmath>

namespace whirl::openocd {
namespace {

constexpr double kZ = 1.959963984540054;  // two-sided 95 % of a normal distribution

}  // namespace

BusyShare busy_share(std::span<const std::uint32_t> pcs, std::span<const IdleSpan> idle,
                     std::uint32_t code_from, std::uint32_t code_to) {
  BusyShare result;
  for (const std::uint32_t pc : pcs) {
    if (pc < code_from || pc >= code_to) {
      ++result.unknown;
      continue;
    }
    ++result.samples;
    const bool sleeps = std::any_of(idle.begin(), idle.end(), [pc](const IdleSpan& span) {
      return pc >= span.from && pc < span.to;
    });
    result.busy += sleeps ? 0 : 1;
  }
  const auto n = static_cast<double>(result.samples);
  if (result.samples == 0) {
    result.share = result.low = result.high = std::nan("");
    return result;
  }
  const double p = static_cast<double>(result.busy) / n;
  const double middle = (p + kZ * kZ / (2 * n)) / (1 + kZ * kZ / n);
  const double half = kZ / (1 + kZ * kZ / n) * std::sqrt(p * (1 - p) / n + kZ * kZ / (4 * n * n));
  result.share = p;
  result.low = std::max(0.0, middle - half);
  result.high = std::min(1.0, middle + half);
  return result;
}

std::vector<IdleSpan> waits_in(std::span<const std::uint8_t> code, std::uint32_t address) {
  std::vector<IdleSpan> spans;
  for (std::size_t i = 0; i + 1 < code.size(); i += 2) {
    if (code[i] != 0x30 || code[i + 1] != 0xBF) continue;
    const auto at = address + static_cast<std::uint32_t>(i);
    spans.push_back({at, at + 4});
  }
  return spans;
}

}  // namespace whirl::openocd
