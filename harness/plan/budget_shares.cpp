#include "harness/plan/budget_shares.hpp"

#include <cmath>
#include <cstdio>
#include <numeric>
#include <span>
#include <vector>

#include "harness/plan/timing_window.hpp"
#include "harness/plan/watched_calls.hpp"

namespace whirl::plan {
namespace {

constexpr double kNs = 1e-9;

// NaN of fewer than two.
double mean_period_s(std::span<const std::int64_t> times_ns) {
  if (times_ns.size() < 2) return std::nan("");
  const auto all_ns = static_cast<double>(times_ns.back() - times_ns.front());
  return kNs * all_ns / static_cast<double>(times_ns.size() - 1);
}

}  // namespace

BudgetShares read_budget_shares(const lua::Table& given, const BoardDescription& board) {
  BudgetShares shares;
  shares.share = optional_limit(given, "share", Dimension::ratio, kShare);
  if (!given.has("rate")) return shares;
  shares.rate = optional_limit(given, "rate", Dimension::ratio, lua::above(0.0));
  shares.every = given.integer_or("every", 1, 1, 1'000'000);
  shares.sensor = board.number(given.text("of"));
  if (shares.sensor < 0) given.refuse("of", "no device of " + board.name);
  return shares;
}

void judge_budget_shares(Script& script, const BudgetShares& shares, const BudgetWindow& w) {
  const results::EventLog& log = script.stage().logs[w.node];
  const double accuracy = script.stage().nodes[w.node].board.timing_accuracy();
  const WatchedCalls calls =
      calls_between(log, static_cast<std::uint16_t>(w.number), w.from_ns, w.to_ns);
  const double window_s = kNs * static_cast<double>(w.to_ns - w.from_ns);
  char note[96] = "";
  if (shares.share) {
    std::snprintf(note, sizeof note, "%zu calls", calls.whole_ns.size());
    for (const WatchedCalls::Cut& cut : calls.cut) {
      if (cut.lasted_s > shares.share->value_SI * window_s)
        script.not_seen_whole("a call had not returned");
    }
    const double execution_s =
        std::accumulate(calls.execution_s.begin(), calls.execution_s.end(), 0.0);
    const double share = calls.whole_ns.empty() ? std::nan("") : execution_s / window_s;
    script.judge_in_window({share, Dimension::ratio, w.function + " share of time"},
                           Script::Figure::of_all, *shares.share, w.place,
                           kNs * static_cast<double>(w.to_ns), note, accuracy);
  }
  if (!shares.rate) return;
  std::vector<std::int64_t> ready_ns;
  const auto ready = log.data_ready_ns.find(static_cast<std::uint16_t>(shares.sensor));
  if (ready != log.data_ready_ns.end()) {
    for (const std::int64_t at_ns : ready->second) {
      if (at_ns >= w.from_ns && at_ns <= w.to_ns) ready_ns.push_back(at_ns);
    }
  }
  const double own_s = static_cast<double>(shares.every) * mean_period_s(ready_ns);
  const double mean_s = mean_period_s(calls.whole_ns);
  std::snprintf(note, sizeof note, "every %.6g ms, the sensor's own %.6g ms", 1e3 * mean_s,
                1e3 * own_s);
  script.judge_in_window(
      {std::abs(mean_s / own_s - 1.0), Dimension::ratio, w.function + " rate error"},
      Script::Figure::of_all, *shares.rate, w.place, kNs * static_cast<double>(w.to_ns), note);
}

}  // namespace whirl::plan
