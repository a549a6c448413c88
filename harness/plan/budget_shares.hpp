// The parts of t:budget that sum up a window: how much of it a function takes, and how often it is called
// by the clock of the sensor that paces it.
//
//   share     of all time, in the function's own context
//   rate      how far the mean period is off `every` periods of the sensor `of`: the sensor's own clock,
//             which may be a percent off, is told beside it and not the firmware's error
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "harness/plan/script.hpp"

namespace whirl::plan {

struct BudgetShares {
  std::optional<Limit> share, rate;
  std::int64_t every = 1;
  int sensor = -1;  // its number on the board
  bool asked() const { return share || rate; }
};

BudgetShares read_budget_shares(const lua::Table& given, const BoardDescription& board);

struct BudgetWindow {
  std::string function, place;
  std::size_t node = 0;
  int number = -1;  // of the function
  std::int64_t from_ns = 0, to_ns = 0;
};
void judge_budget_shares(Script& script, const BudgetShares& shares, const BudgetWindow& window);

}  // namespace whirl::plan
