// One line of a table of parts: what a number of a copy is drawn from.
#pragma once
#include "plant/parts/spread.hpp"

namespace whirl::plant {

struct PartNumber {
  const char* group;
  const char* name;
  const char* unit;  // of what is drawn; "" is a share
  bool of_nominal;
  Spread spread;
  const char* source;
};

}  // namespace whirl::plant
