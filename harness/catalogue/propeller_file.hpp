// A propeller as a Lua file (test_plans/propellers): stations, and either the polars it names or static rows
// on which the blade's traits are fitted (plant/rotor/fitted_blade.hpp). Polars are looked for beside
// the file, then in plant/data/polars of the house.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "base/result.hpp"
#include "plant/rotor/blade.hpp"
#include "plant/rotor/fitted_blade.hpp"

namespace whirl::catalogue {

struct PropellerFile {
  std::shared_ptr<const plant::Blade> blade;
  std::optional<plant::FittedBlade> fit;  // where the file names no polars
};
Result<PropellerFile> read_propeller_file(const std::string& path);
// The blade alone.
Result<std::shared_ptr<const plant::Blade>> read_propeller(const std::string& path);

}  // namespace whirl::catalogue
