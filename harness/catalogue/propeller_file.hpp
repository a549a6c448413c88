// A propeller as a Lua file (test_plans/propellers): stations, sections, and the polars it names.
// Polars are looked for beside the file, then in plant/data/polars of the house. A file that names
// none gets sections by its thickness (plant/rotor/section_rules.hpp).
#pragma once
#include <memory>
#include <string>

#include "base/result.hpp"
#include "plant/rotor/blade.hpp"

namespace whirl::catalogue {

Result<std::shared_ptr<const plant::Blade>> read_propeller(const std::string& path);

}  // namespace whirl::catalogue
