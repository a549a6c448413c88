// A propeller along its shaft, fast: what a fit asks some ten thousand times.
//
//   What    the rotor's own balance (ring_balance.hpp) in axial flow with the same rings, solved for the inflow
//           angle of each ring; sections by formula instead of tables.
//   Valid   J >= 0, air through the disc from the front; standard air at sea level.
//   Error   against Rotor::steady under 1 % of static CT and CP (tests/blade_fit_test.cpp)
#pragma once
#include <vector>

#include "plant/rotor/blade_traits.hpp"
#include "plant/rotor/twist_fit.hpp"

namespace whirl::plant {

struct AxialRing {
  double r_over_R = 0.0;
  double dr_over_R = 0.0;
  double c_over_R = 0.0;
  double angle_rad = 0.0;
};
struct AxialBlade {
  int count = 2;
  double radius_m = 0.0;
  double hub_over_R = 0.0;
  std::vector<AxialRing> rings;
};
AxialBlade axial_blade(const PropellerDescription& description, int rings);

PropellerCoefficients axial_coefficients(const AxialBlade& blade, const TraitVector& traits,
                                         double omega_radps, double advance_ratio);

}  // namespace whirl::plant
