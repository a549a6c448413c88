// One plan on many seeds: of each expectation the mean, the spread and the worst.
//
//   Same      expectations of two runs are the same where their names are; of several of one name in a
//             run the first is the first's, and so on
//   Sigma     standard deviation of what was measured, with n - 1; NaN of fewer than two
//   NaN       what could not be measured counts among the runs that did not meet it, and not in the mean
//   Units     as the plan wrote them (results/report.hpp)
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "results/charts.hpp"
#include "results/report.hpp"

namespace whirl::results {

struct SeedRun {
  Report report;
  std::string folder;  // of its files; empty: it has none
};

struct SpreadRow {
  std::string name;  // "tilt", "tilt (2)" of the second of that name
  std::string unit;
  std::string
      limit;  // "at most 50 ms"; of limits that differ from seed to seed the first, and "..."
  bool numbers = false;  // false: it holds or it does not
  std::size_t runs = 0, met = 0;
  double mean = 0, sigma = 0, lowest = 0, highest = 0;
  double least_margin = 0;
  std::uint64_t lowest_seed = 0, highest_seed = 0, least_margin_seed = 0;
};

struct Spread {
  std::string plan, file;
  std::size_t runs = 0, passed = 0;
  std::vector<std::uint64_t> seeds;  // as they came, ascending
  std::vector<SpreadRow> rows;       // in the order of the plan
};

// Of runs of one plan. Their order does not matter.
Spread spread_of(const std::vector<const SeedRun*>& runs);

std::string spread_text(const Spread& spread);                    // for terminals
std::string spread_csv(const std::vector<const SeedRun*>& runs);  // a line per expectation and seed
std::string spread_html(const Spread& spread, const std::vector<Chart>& charts);

}  // namespace whirl::results
