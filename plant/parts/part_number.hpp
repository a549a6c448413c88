// One line of a table of parts: what a number of a copy is drawn from.
#pragma once
#include <map>
#include <optional>
#include <string>

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

using Tolerances = std::map<std::string, ToleranceClass>;  // by group; none where missing

// One copy's. Nothing: its group is as drawn.
std::optional<double> draw(const PartNumber& part, const Tolerances& chosen, std::uint64_t seed,
                           const std::string& stream);

}  // namespace whirl::plant
