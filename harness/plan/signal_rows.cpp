#include "harness/plan/signal_rows.hpp"

#include <algorithm>

namespace whirl::plan {
namespace {

constexpr std::int64_t kBefore_ns = 200'000'000;  // the reference of a change

}  // namespace

SignalRows::SignalRows(std::vector<results::Column> columns, std::int64_t step_ns)
    : columns_(std::move(columns)),
      step_ns_(step_ns),
      kept_(static_cast<std::size_t>(kBefore_ns / step_ns) + 1),
      past_(kept_ * columns_.size()) {}

void SignalRows::append(std::span<const double> row) {
  std::copy(row.begin(), row.end(),
            past_.begin() + static_cast<std::ptrdiff_t>(rows_ % kept_ * columns_.size()));
  ++rows_;
  for (const std::size_t number : open_) {
    Recording& record = records_[number];
    for (std::size_t i = 0; i < record.columns.size(); ++i) {
      record.values[i].push_back(row[record.columns[i]]);
    }
  }
}

double SignalRows::last(std::size_t column) const {
  return past_[(rows_ - 1) % kept_ * columns_.size() + column];
}

std::size_t SignalRows::open_record(std::vector<std::size_t> columns) {
  Recording record{std::move(columns), {}, std::min(rows_, kept_) - 1};
  for (const std::size_t column : record.columns) {
    auto& values = record.values.emplace_back();
    for (std::size_t row = rows_ - 1 - record.command; row < rows_; ++row) {
      values.push_back(past_[row % kept_ * columns_.size() + column]);
    }
  }
  records_.push_back(std::move(record));
  open_.push_back(records_.size() - 1);
  return records_.size() - 1;
}

void SignalRows::close_record(std::size_t number) {
  std::erase(open_, number);
}

metrics::Record SignalRows::record(std::size_t number, std::size_t column) const {
  const Recording& record = records_[number];
  const auto at = std::find(record.columns.begin(), record.columns.end(), column);
  const auto& values = record.values[static_cast<std::size_t>(at - record.columns.begin())];
  return {values, step_ns_, record.command};
}

}  // namespace whirl::plan
