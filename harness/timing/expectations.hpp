// What each kernel of a timing image should cost, by the data sheets (io_bridges/qemu/data/timing_PART.txt).
//
//   Lines   "section TITLE", "row KERNEL WAIT_STATES LOW HIGH SOURCE DERIVATION", "#..." and empty ones
//   Range   cycles per iteration, ends included, 0 < LOW <= HIGH; "- -": no source gives one, it is only
//           reported. Where a source gives a range, LOW and HIGH are its ends, not a tolerance
//   Source  a key of io_bridges/qemu/REFERENCES.md, or several joined by "+"
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"

namespace whirl::timing {

struct Expectation {
  std::string section, kernel;
  unsigned wait_states = 0;
  bool judged = true;
  double low_cycles = 0.0, high_cycles = 0.0;  // per iteration; 0 where it is not judged
  std::string source, derivation;
};

Result<std::vector<Expectation>> read_expectations(std::string_view text, const std::string& place);

}  // namespace whirl::timing
