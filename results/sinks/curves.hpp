// What a page draws of the signals, in bounded memory: the lowest and the highest value of each stretch,
// so that no spike is lost.
#pragma once
#include <cstdint>
#include <vector>

#include "results/sinks/sink.hpp"

namespace whirl::results {

class Curves : public Sink {
 public:
  struct Curve {
    std::vector<double> low, high;  // of each stretch
    bool constant = true;           // so far: no NaN, and one value
  };

  // No curves: of a run that never began.
  Curves() = default;
  Curves(std::vector<Column> columns, std::int64_t step_ns, std::uint64_t rows);

  void on_row(std::int64_t t_ns, std::span<const double> values) override;
  std::vector<Error> finish() override { return {}; }

  const std::vector<Column>& columns() const { return columns_; }
  std::int64_t step_ns() const { return step_ns_; }
  std::uint64_t stride() const { return stride_; }  // rows per stretch
  const Curve& curve(std::size_t column) const { return curves_[column]; }

 private:
  std::vector<Column> columns_;
  std::int64_t step_ns_ = 1'000'000;
  std::uint64_t stride_ = 1, rows_ = 0;
  std::vector<Curve> curves_;
};

}  // namespace whirl::results
