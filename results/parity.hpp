// Two runs of one plan side by side, the virtual board's and a bench's, or one board's and several boards': figure by
// figure.
//
//   Pairs     by the name of the expectation, in the first run's order; of one name several times, in their order
//   Differ    (second - first) / |first|; NaN where one of the two has no number, or the first is 0. Marked beyond
//            kMarked
#pragma once
#include <string>
#include <vector>

#include "results/report.hpp"

namespace whirl::results {

inline constexpr double kMarked = 0.05;

struct ParityRow {
  std::string name, unit, limit;
  double first = 0.0, second = 0.0;  // NaN: not measured there, or not there at all
  double difference = 0.0;           // share
  bool first_met = false, second_met = false, in_both = false;
  bool marked() const { return difference > kMarked || difference < -kMarked; }
};

std::vector<ParityRow> parity(const Report& first, const Report& second);
std::string parity_text(const Report& first, const Report& second);
std::string parity_page(const Report& first, const Report& second);  // HTML, whole in itself

}  // namespace whirl::results
