// What a run's stand, vehicle and boards are by its seed: another copy of the hardware.
#pragma once
#include "harness/catalogue/stand_table.hpp"
#include "harness/catalogue/vehicle_file.hpp"
#include "harness/cli/composition.hpp"
#include "harness/flight/vehicle_parts.hpp"
#include "harness/stand/stand_parts.hpp"

namespace whirl {

inline Result<stand::StandParams> stand_of(const cli::Setup& setup) {
  auto params = catalogue::read_stand(*setup.plan.stand, setup.root + "/test_plans/propellers");
  if (params && setup.bench == nullptr) {
    stand::draw_parts(params.value(), setup.board, setup.seed);
  }
  return params;
}

inline Result<flight::FlightParams> vehicle_of(const cli::Setup& setup) {
  auto params = catalogue::read_vehicle(setup.vehicle_file, setup.settings);
  if (params) flight::draw_parts(params.value(), setup.seed);
  return params;
}

// Each board of a run is another copy of the hardware.
inline std::uint64_t seed_of(const cli::Setup& setup, std::size_t node) {
  return setup.seed + (static_cast<std::uint64_t>(node) << 32);
}

}  // namespace whirl
