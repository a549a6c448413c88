// Overlapping-free Allan deviation by its definition, for tests.
#pragma once
#include <cmath>
#include <vector>

namespace whirl::plant {

inline double allan_deviation(const std::vector<double>& x, double dt_s, double tau_s) {
  const std::size_t n = static_cast<std::size_t>(std::lround(tau_s / dt_s));
  double before = 0.0, sum = 0.0;
  std::size_t count = 0;
  for (std::size_t start = 0; start + n <= x.size(); start += n) {
    double mean = 0.0;
    for (std::size_t k = 0; k < n; ++k) mean += x[start + k] / static_cast<double>(n);
    if (start > 0) {
      sum += (mean - before) * (mean - before);
      ++count;
    }
    before = mean;
  }
  return std::sqrt(0.5 * sum / static_cast<double>(count));
}

}  // namespace whirl::plant
