// Akima's spline through a section table, which the reference solver interpolates with.
//   Source  [Akima1970]
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

namespace whirl::plant {

class Akima {
 public:
  Akima(std::vector<double> x, std::vector<double> y) : x_(std::move(x)), y_(std::move(y)) {
    const std::size_t n = x_.size();
    std::vector<double> m(n + 3);  // slopes, two extended at either end
    for (std::size_t i = 0; i + 1 < n; ++i) m[i + 2] = (y_[i + 1] - y_[i]) / (x_[i + 1] - x_[i]);
    m[1] = 2.0 * m[2] - m[3];
    m[0] = 2.0 * m[1] - m[2];
    m[n + 1] = 2.0 * m[n] - m[n - 1];
    m[n + 2] = 2.0 * m[n + 1] - m[n];
    slope_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const double after = std::abs(m[i + 3] - m[i + 2]);
      const double before = std::abs(m[i + 1] - m[i]);
      slope_[i] = after + before > 1e-30 ? (after * m[i + 1] + before * m[i + 2]) / (after + before)
                                         : 0.5 * (m[i + 1] + m[i + 2]);
    }
  }

  double operator()(double x) const {
    const auto above = std::upper_bound(x_.begin() + 1, x_.end() - 1, x);
    const auto i = static_cast<std::size_t>(above - x_.begin()) - 1;
    const double h = x_[i + 1] - x_[i];
    const double t = (x - x_[i]) / h;
    const double rise = y_[i + 1] - y_[i];
    const double a = slope_[i] * h;
    const double b = slope_[i + 1] * h;
    return y_[i] + t * (a + t * (3.0 * rise - 2.0 * a - b + t * (a + b - 2.0 * rise)));
  }

 private:
  std::vector<double> x_, y_, slope_;
};

}  // namespace whirl::plant
