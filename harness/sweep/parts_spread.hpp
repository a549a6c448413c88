// What the numbers of a part are over many copies of it, beside what their class allows.
//
//   Rows    one for each number that was drawn; those of all motors ("motor 3 resistance") make one
//   Units   as drawn: SI; what has none is a share
//   Sigma   with n - 1; NaN of one copy, "-" in the table
//   From, to   between what the class allows every copy to be
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "plant/parts/part_number.hpp"
#include "results/charts.hpp"
#include "results/spread/sums.hpp"

namespace whirl::sweep {

struct NumberSpread {
  const plant::PartNumber* number;
  plant::DrawRange allowed;
  results::Sums sums = {};
  double least = std::numeric_limits<double>::infinity(),
         most = -std::numeric_limits<double>::infinity();
};

class PartsSpread {
 public:
  // Of groups that are none there is no row.
  PartsSpread(const std::vector<const plant::PartNumber*>& numbers,
              const plant::Tolerances& tolerance);

  // Pre: `drawn` is one of the numbers, with its owner before it or without.
  void add(const std::string& drawn, double value);

  std::vector<NumberSpread> rows() const;  // that were drawn at all
  results::ChartTable table() const;
  std::string text() const;  // the same for a terminal
  std::string csv() const;

 private:
  std::vector<NumberSpread> rows_;
};

}  // namespace whirl::sweep
