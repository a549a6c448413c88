// What a timing image (firmware/timing) sent, from the virtual board or from a part on the table.
//
//   Lines  "timing 1 PART", "row NAME ITERATIONS CYCLES", ..., "end ROWS"; one such block per part
//   Loose  line ends of either kind; what stands outside of a block (a terminal's own words) is skipped
//   Error  inside of a block: a line of another form, a number out of range, a name that comes twice
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"

namespace whirl::timing {

struct Row {
  std::string kernel;
  std::uint32_t iterations = 1;  // above 0
  std::uint32_t cycles = 0;      // of all iterations together
  double cycles_per_iteration() const { return static_cast<double>(cycles) / iterations; }
};

struct Report {
  std::string part;
  std::vector<Row> rows;
  bool complete = false;  // its last line came, and named as many rows as came
};

// `place`: of the text, for errors. No block at all is an error.
Result<std::vector<Report>> read_reports(std::string_view text, const std::string& place);

}  // namespace whirl::timing
