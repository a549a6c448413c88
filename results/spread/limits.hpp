// Limits that a small regression would break, proposed from what a plan measured on many seeds.
//
//   Place    one proposal for each line of the plan (and unit, and kind of limit): a line that judges in a loop is one limit
//            for all of it
//   Upper    worst + margin |worst|; lower: worst - margin |worst|; a range of two sides: each side moves away from
//            what was measured by margin times the spread between lowest and highest (three sigma if that is more)
//   Rounded  outwards to two digits, of a range to a hundredth of its width
//   Left     what holds or does not, limits that are exact (equal), a worst of nothing (0), and what some run could
//            not measure: no number follows from these
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "results/spread/spread.hpp"

namespace whirl::results {

struct ProposedLimit {
  std::string place;  // "hover.lua:31"
  std::string name;   // of the worst one, of those that are judged there
  std::string unit, how;
  std::size_t judged = 0;           // expectations of one run that this line judges
  std::optional<double> low, high;  // as it stands
  std::optional<double> low_proposed, high_proposed;  // what would do
  double lowest = 0.0, highest = 0.0;                 // measured
  std::uint64_t lowest_seed = 0, highest_seed = 0;
};

// Pre: runs of one plan; margin > 0, relative (0.3).
std::vector<ProposedLimit> propose_limits(const std::vector<const SeedRun*>& runs, double margin);

std::string limits_text(const std::vector<ProposedLimit>& limits, double margin);

}  // namespace whirl::results
