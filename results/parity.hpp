// Two runs of one plan side by side, the virtual board's and a bench's, or one board's and several boards': figure by
// figure.
//
//   Pairs     by the name of the expectation, in the first run's order; of one name several times, in their order
//   Differ    (second - first) / |first|; NaN where one of the two has no number. From 0 to another figure is no share: it is
//            infinite, of the difference's sign, and told as "from 0"
//   Marked    beyond kMarked either way; and where the two were judged by different limits, which both are told
#pragma once
#include <string>
#include <vector>

#include "results/report.hpp"

namespace whirl::results {

inline constexpr double kMarked = 0.05;

struct ParityRow {
  std::string name, unit, limit;
  std::string second_limit = {};     // where it is another one
  double first = 0.0, second = 0.0;  // NaN: not measured there, or not there at all
  double difference = 0.0;           // share
  bool first_met = false, second_met = false, in_both = false;
  bool marked() const { return difference > kMarked || difference < -kMarked; }
  bool limits_differ() const { return in_both && !second_limit.empty(); }
};

std::vector<ParityRow> parity(const Report& first, const Report& second);
std::string parity_text(const Report& first, const Report& second);
std::string parity_page(const Report& first, const Report& second);  // HTML, whole in itself

}  // namespace whirl::results
