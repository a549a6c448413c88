#include "results/sinks/curves.hpp"

#include <algorithm>
#include <cmath>

namespace whirl::results {
namespace {

constexpr std::uint64_t kPoints = 900;

}  // namespace

Curves::Curves(std::vector<Column> columns, std::int64_t step_ns, std::uint64_t rows)
    : columns_(std::move(columns)),
      step_ns_(step_ns),
      stride_(std::max<std::uint64_t>(1, (rows + kPoints - 1) / kPoints)),
      curves_(columns_.size()) {}

void Curves::on_row(std::int64_t /*t_ns*/, std::span<const double> values) {
  const bool begins = rows_++ % stride_ == 0;
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    Curve& c = curves_[i];
    const double x = values[i];
    c.constant = c.constant && !std::isnan(x) && (c.low.empty() || x == c.low.front());
    if (begins) {
      c.low.push_back(x);
      c.high.push_back(x);
    }
    // fmin and fmax leave a NaN aside wherever there is a number.
    c.low.back() = std::fmin(c.low.back(), x);
    c.high.back() = std::fmax(c.high.back(), x);
  }
}

}  // namespace whirl::results
