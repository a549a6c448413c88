// A thing as it is bought: what each seed draws of it, for who wants to see the spread.
//
//   File     a vehicle; a stand (a calibration's file); a motor or a propeller, drawn as the first of a vehicle
//   Class    what the file's `tolerance` says; typical where it says nothing
//   Drawn    by the same code and streams as in a run of that seed
//   Errors   bad_input, of the file; a kind that has no copies
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "harness/world/drawn_part.hpp"
#include "plant/parts/part_number.hpp"

namespace whirl::catalogue {

struct Copies {
  std::string name;
  plant::Tolerances tolerance;
  std::vector<const plant::PartNumber*> numbers;  // all that may be drawn of it
  std::function<std::vector<DrawnPart>(std::uint64_t seed)> of_seed;
};

// `tolerance`: of all groups, instead of the file's; nothing: the file's. `propellers`: a stand's folder of them.
Result<Copies> read_copies(const std::string& path, std::optional<plant::ToleranceClass> tolerance,
                           const std::string& propellers);

}  // namespace whirl::catalogue
