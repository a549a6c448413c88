// Momentum balance of one ring of the disc: which thrust belongs to an induced velocity.
//
//   Frame    u > 0 blows along the thrust's reaction (down for a hovering rotor); V > 0 is air that
//            already comes that way (climb); Vxy is the flow in the plane of the disc.
//   Closure  thrust per unit area = 2 rho F u m,  m = sqrt(Vxy^2 + (u f(V/u))^2). Outside the
//            vortex-ring state f = |1 + V/u|: Glauert's momentum theory. Within -2 < V/u < 0 f is a
//            smooth curve through the measured induced velocities of a rotor in vertical descent.
//            Odd in u and rising: one root for a given thrust, whatever the state.
//   Twist    twelve degrees of it raise the peak by 24 % and move it to 17 % more descent [CastlesGray];
//            here by 18 % and 5 %, more would leave a thrust two roots. `twist` is the share of those
//            twelve degrees: 1 for all that propellers have, 0 for the quartic below
//   Source   [Glauert], [Leishman, eq. 2.96]: u/vh = 1 - 1.125 x - 1.372 x^2 - 1.718 x^3 - 0.655 x^4
//   Left out what makes a propeller's mean thrust fall much at a constant speed, most at 1.2 to 1.3 vh of
//            descent [Veismann], [ShettySelig]: here it falls by one percent at 1.3 to 1.6 vh, after it
//            has risen by two (tests/vortex_ring_test.cpp)
//   Error    u against that quartic within 4 %; the data behind it scatter by 15 %
//            (validation/momentum_limits.cpp)
#pragma once
#include <algorithm>
#include <cmath>

namespace whirl::plant {

// f(xi) for xi = V/u. Between its two momentum branches a quartic in xi with slopes matched at
// both ends (d|1+xi|/dxi = 1 at hover, -1 at the windmill brake state).
inline double mass_flow_shape(double xi, double twist = 0.0) {
  if (xi >= 0.0 || xi <= -2.0) return std::abs(1.0 + xi);
  // z runs from -1 (windmill brake) to 1 (hover). The polynomial part meets f = 1 with slope 1 at
  // both ends; the bump in the middle carries the fit.
  const double z = xi + 1.0;
  const double z2 = z * z;
  const double q = 1.0 - z2;
  const double bump = -z * (0.4522 + z * (0.3873 + z * (0.0926 - 0.1230 * z)));
  const double untwisted = 0.3107 + 0.8786 * z2 - 0.1893 * z2 * z2 + bump * q * q;
  // Where t runs from 0 to 1 the twisted rotor needs more induced velocity for its thrust.
  const double t = (-0.42 - xi) / 0.62;
  if (!(t > 0.0 && t < 1.0)) return untwisted;
  const double falls = (1.0 - t) * (1.0 - t);
  return untwisted - twist * 3.645 * t * t * falls * falls;
}

inline double mass_flow_mps(double u, double V, double Vxy, double twist = 0.0) {
  const double axial = u == 0.0 ? V : u * mass_flow_shape(V / u, twist);
  return std::sqrt(Vxy * Vxy + axial * axial);
}

// One end's share of Prandtl's loss for f = blades/2 x relative distance / sin(phi). Beyond f = 16 it
// differs from 1 by less than 1e-7.
inline double prandtl_share(double f) {
  constexpr double kTwo_over_pi = 0.63661977236758134;
  return f > 16.0 ? 1.0 : kTwo_over_pi * std::acos(std::exp(-f));
}

// Prandtl's factor for the tip and the root of B blades; phi is the local inflow angle. A radius of
// zero switches that end's loss off. Bounded below: at the very tip no air at all would be moved.
inline double prandtl_loss(double r, double tip, double root, int blades, double sin_phi) {
  const double s = std::max(std::abs(sin_phi), 1e-6);
  double F = 1.0;
  if (tip > 0.0) F *= prandtl_share(0.5 * blades * (tip / r - 1.0) / s);
  if (root > 0.0) F *= prandtl_share(0.5 * blades * (r / root - 1.0) / s);
  return std::max(F, 1e-3);
}

}  // namespace whirl::plant
