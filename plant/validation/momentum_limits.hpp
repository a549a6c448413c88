// Momentum theory in closed form, and the rotor that reaches it.
//
//   Hover         u = sqrt(T / (2 rho A)); climb and windmill brake state: the two roots of
//                 T = 2 rho A u |V + u|
//   Descent       between them the curve measured in vertical descent [Leishman, eq. 2.96]
//   Forward       Glauert: u -> T / (2 rho A Vxy) for fast flight in the plane of the disc
//   Optimum blade c = ctip R/r at one angle of attack: uniform inflow and the thrust and power of
//                 [Bangura2017, eq. 4.66-4.68]
#pragma once
#include "plant/validation/report.hpp"

namespace whirl::plant {

Report validate_momentum_limits();

}  // namespace whirl::plant
