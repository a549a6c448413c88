// A number of one copy of the hardware that was drawn for this run, for its results.
#pragma once
#include <string>

namespace whirl {

struct DrawnPart {
  std::string name;  // "divider.a.upper"
  double value = 0.0;
  std::string unit;  // "V"; "" is a share of the nominal
};

}  // namespace whirl
