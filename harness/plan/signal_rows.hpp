// The world's signals as a plan may ask for them, in bounded memory: the latest row, and of each record
// its own columns from 200 ms before its command to its end.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "harness/metrics/response.hpp"
#include "results/messages/run_head.hpp"

namespace whirl::plan {

class SignalRows {
 public:
  SignalRows(std::vector<results::Column> columns, std::int64_t step_ns);

  // ages_ns: of the values; empty: all are of this row's time, as in all rows before and behind it.
  void append(std::span<const double> row, std::span<const std::int64_t> ages_ns = {});

  const std::vector<results::Column>& columns() const { return columns_; }
  std::int64_t step_ns() const { return step_ns_; }
  double last(std::size_t column) const;  // Pre: a row is there

  // A record of these columns, whose command comes at the latest row. Its number.
  std::size_t open_record(std::vector<std::size_t> columns);
  void close_record(std::size_t number);  // the latest row is its last
  // Pre: the record has that column.
  metrics::Record record(std::size_t number, std::size_t column) const;

 private:
  struct Recording {
    std::vector<std::size_t> columns;
    std::vector<std::vector<double>> values;         // of each
    std::vector<std::vector<std::int64_t>> ages_ns;  // of each; empty: all are of their row's time
    std::size_t command = 0;
  };

  std::vector<results::Column> columns_;
  std::int64_t step_ns_;
  std::size_t kept_;          // rows of the past: the reference of a change, and the latest
  std::vector<double> past_;  // a ring of them
  std::vector<std::int64_t> past_ages_ns_;
  std::size_t rows_ = 0;  // ever
  std::vector<Recording> records_;
  std::vector<std::size_t> open_;  // of the records
};

}  // namespace whirl::plan
