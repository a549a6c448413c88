// A propeller's tip twist from its static thrust alone, where its sections are named (else: fitted_blade.hpp).
//
//   Why    blade angles read off photographs are a few degrees low outboard; one number, added in
//          proportion to r/R, puts the mean static thrust right and leaves torque and forward flight
//          to be foretold.
//   Valid  correction within +-8 deg; the error says when static thrust cannot be met with that.
#pragma once
#include <memory>
#include <vector>

#include "plant/rotor/blade.hpp"

namespace whirl::plant {

// The smallest correction that meets the summed thrust coefficient; description.tip_twist_correction_rad is ignored.
Result<double> fit_tip_twist_rad(PropellerDescription description,
                                 const std::vector<StaticPoint>& points);

// The blade of a description; where it brings static points, with the twist that they ask for.
Result<std::shared_ptr<const Blade>> make_fitted_blade(PropellerDescription description);

struct PropellerCoefficients {
  double CT = 0.0;  // T / (rho n^2 D^4)
  double CP = 0.0;  // P / (rho n^3 D^5)
};
// Steady, along the shaft, at sea level; J = V / (n D).
PropellerCoefficients propeller_coefficients(const std::shared_ptr<const Blade>& blade,
                                             double omega_radps, double advance_ratio);

}  // namespace whirl::plant
