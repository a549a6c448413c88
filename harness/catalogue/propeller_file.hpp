// A propeller as a Lua file (test_plans/propellers): stations, and either the polars it names or static rows
// on which the blade's traits are fitted (plant/rotor/fitted_blade.hpp). Polars are looked for beside
// the file, then in plant/data/polars of the house.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "plant/rotor/blade.hpp"
#include "plant/rotor/fitted_blade.hpp"

namespace whirl::catalogue {

struct PropellerFile {
  std::shared_ptr<const plant::Blade> blade;
  std::shared_ptr<const plant::FittedBlade> fit;     // where the file names no polars, else null
  std::shared_ptr<const plant::TwistedBlade> twist;  // where it does, else null
  // What speaks against the file, each with the propeller's name before it.
  std::vector<std::string> doubts() const;
};
Result<PropellerFile> read_propeller_file(const std::string& path);
// The blade alone.
Result<std::shared_ptr<const plant::Blade>> read_propeller(const std::string& path);

}  // namespace whirl::catalogue
