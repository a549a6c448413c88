// Of times that were measured: the median, the 99th percentile and the longest, in milliseconds.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

namespace whirl::bench {

struct Spread {
  double p50_ms = 0, p99_ms = 0, most_ms = 0;
};

inline Spread spread_of(std::vector<double> all_ms) {
  if (all_ms.empty()) return {};
  std::sort(all_ms.begin(), all_ms.end());
  const auto at = [&](double share) {
    const auto n = static_cast<std::size_t>(share * static_cast<double>(all_ms.size()));
    return all_ms[std::min(all_ms.size() - 1, n)];
  };
  return {at(0.5), at(0.99), all_ms.back()};
}

}  // namespace whirl::bench
