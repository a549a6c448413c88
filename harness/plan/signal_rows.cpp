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

void SignalRows::append(std::span<const double> row, std::span<const std::int64_t> ages_ns) {
  const auto at = static_cast<std::ptrdiff_t>(rows_ % kept_ * columns_.size());
  std::copy(row.begin(), row.end(), past_.begin() + at);
  if (!ages_ns.empty()) {
    past_ages_ns_.resize(past_.size());
    std::copy(ages_ns.begin(), ages_ns.end(), past_ages_ns_.begin() + at);
  }
  ++rows_;
  for (const std::size_t number : open_) {
    Recording& record = records_[number];
    for (std::size_t i = 0; i < record.columns.size(); ++i) {
      record.values[i].push_back(row[record.columns[i]]);
      if (!ages_ns.empty()) record.ages_ns[i].push_back(ages_ns[record.columns[i]]);
    }
  }
}

double SignalRows::last(std::size_t column) const {
  return past_[(rows_ - 1) % kept_ * columns_.size() + column];
}

std::size_t SignalRows::open_record(std::vector<std::size_t> columns) {
  Recording record{std::move(columns), {}, {}, std::min(rows_, kept_) - 1};
  for (const std::size_t column : record.columns) {
    auto& values = record.values.emplace_back();
    auto& ages_ns = record.ages_ns.emplace_back();
    for (std::size_t row = rows_ - 1 - record.command; row < rows_; ++row) {
      const std::size_t at = row % kept_ * columns_.size() + column;
      values.push_back(past_[at]);
      if (!past_ages_ns_.empty()) ages_ns.push_back(past_ages_ns_[at]);
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
  const auto i = static_cast<std::size_t>(at - record.columns.begin());
  return {record.values[i], step_ns_, record.command, record.ages_ns[i]};
}

}  // namespace whirl::plan
