// Mean and standard deviation of what comes one by one.
//
//   Method  [Welford 1962]: exact also where numbers differ little from each other
//   Sigma   with n - 1; NaN of fewer than two
#pragma once
#include <cmath>
#include <cstddef>

namespace whirl::results {

struct Sums {
  std::size_t n = 0;
  double mean = 0, squares = 0;

  void add(double x) {
    ++n;
    const double before = x - mean;
    mean += before / static_cast<double>(n);
    squares += before * (x - mean);
  }
  double sigma() const {
    return n > 1 ? std::sqrt(squares / static_cast<double>(n - 1)) : std::nan("");
  }
};

}  // namespace whirl::results
