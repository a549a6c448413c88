// Truth of a run: every signal at every step, kept in memory and written as truth.csv at the end.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace whirl::results {

class TruthLog {
 public:
  struct Column {
    std::string name;         // "height"
    std::string unit_suffix;  // "mps"; empty for ratios and numbers
    std::string unit;         // "m/s", for people
  };

  TruthLog(std::vector<Column> columns, std::int64_t step_ns)
      : columns_(std::move(columns)), step_ns_(step_ns), values_(columns_.size()) {}

  void append(std::span<const double> row) {
    for (std::size_t i = 0; i < values_.size(); ++i) values_[i].push_back(row[i]);
  }

  const std::vector<Column>& columns() const { return columns_; }
  std::int64_t step_ns() const { return step_ns_; }
  std::size_t rows() const { return values_.empty() ? 0 : values_.front().size(); }
  std::span<const double> values(std::size_t column) const { return values_[column]; }
  double last(std::size_t column) const { return values_[column].back(); }
  // The first row is at t = 0.
  std::size_t row_at(std::int64_t t_ns) const { return static_cast<std::size_t>(t_ns / step_ns_); }

  Result<Done> write_csv(const std::string& path) const;

 private:
  std::vector<Column> columns_;
  std::int64_t step_ns_;
  std::vector<std::vector<double>> values_;
};

}  // namespace whirl::results
