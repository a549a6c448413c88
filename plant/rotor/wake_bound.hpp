// How much one rotor's wake can take from another's thrust at most, where the vehicle has them side by side
// in one plane. Nothing of it is in the flight: it is what the flight leaves out.
//
//   Model    in forward flight the front rotor is a wing of its own span, whose wake is a flat sheet of
//            elliptical loading that sinks as it goes downstream; fully rolled out it blows down at 2 u at
//            its middle, and at height h above it at 2 u (1 - h / sqrt(h^2 + R^2)): exact for the sheet
//   Bound    the sheet sinks by no more than u on its way (it sinks by up to 2 u), is all rolled out at the
//            rear rotor, and that one lies with its whole disc at the sheet's middle
//   Source   induced velocity in forward flight [Glauert]; elliptical sheet: any wing theory
//   Left out above hover: what rotors side by side do to one another without wind (a percent or two)
#pragma once
#include <algorithm>
#include <cmath>

namespace whirl::plant {

// Glauert's induced velocity in level flight, for that of hover.
inline double forward_induced_mps(double hover_mps, double speed_mps) {
  const double v2 = speed_mps * speed_mps, h2 = hover_mps * hover_mps;
  return std::sqrt(0.5 * (std::sqrt(v2 * v2 + 4.0 * h2 * h2) - v2));
}

// Air that comes down through a rotor `behind_m` downstream of one that flies at speed_mps.
inline double wake_inflow_bound_mps(double hover_mps, double speed_mps, double behind_m,
                                    double radius_m) {
  if (!(speed_mps > 0.0 && behind_m > 0.0)) return 0.0;
  const double u = forward_induced_mps(hover_mps, speed_mps);
  const double above_m = u * behind_m / speed_mps;
  return 2.0 * u * (1.0 - above_m / std::hypot(above_m, radius_m));
}

}  // namespace whirl::plant
