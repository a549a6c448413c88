// The balance of one ring: blade thrust against momentum, blade torque against swirl.
//
//   What     balance_ring() finds the axial (u) and swirl (v) velocity at which the loads that the
//            blades give equal what the air takes away; every steady solution in this folder, and
//            the reference cases, go through it. step() relaxes towards the same balance.
//   Solver   bracketed in u: blade thrust falls with u, momentum thrust rises without bound, so a
//            sign change always exists (after stall there may be several; one is found). v is
//            settled inside for every u.
//   Source   4 pi r rho F u m / k = dT/dr, 4 pi r rho F v m = dFt/dr: [Leishman, ch. 3], m: momentum.hpp
#pragma once
#include <algorithm>
#include <cmath>

#include "plant/rotor/momentum.hpp"

namespace whirl::plant {

struct RingWake {
  double r_m = 0.0;
  double dr_m = 0.0;
  double density_kgpm3 = 1.225;
  double climb_mps = 0.0;
  double in_plane_mps = 0.0;
  double blade_speed_mps = 0.0;  // omega r
  int blade_count = 2;
  double tip_m = 0.0;   // 0: no tip loss
  double root_m = 0.0;  // 0: no root loss
  bool swirl = true;
  // Induced power factor: what wake contraction and the vortices of few blades cost beyond the ideal
  // ring with Prandtl's losses. 1 for the ideal ring (reference cases).
  double induced_factor = 1.0;
  double twist = 0.0;  // momentum.hpp: of the blade, what it does to the vortex ring
};

// What balance_ring() asks of the blades at (u, v); all blades, mean over a revolution.
struct RingForce {
  double thrust_N = 0.0;
  double drive_N = 0.0;  // against the turning
  double sin_phi = 0.0;  // of the mean flow
};

struct RingMomentum {
  double thrust_N = 0.0;
  double slope_N_per_mps = 0.0;  // d(thrust)/du, a positive estimate
  double swirl_mps = 0.0;        // that the ring's tangential force asks for
};

// In hover the contracted tip vortices pass close under the next blade; through-flow carries them off.
// `extra` over the ideal ring in hover falls with the cube of the share of u in all air that passes.
inline double induced_factor(double hover_factor, double u_mps, double mass_flow_mps) {
  const double share = std::abs(u_mps) < mass_flow_mps ? std::abs(u_mps) / mass_flow_mps : 1.0;
  return 1.0 + (hover_factor - 1.0) * share * share * share;
}

inline RingMomentum ring_momentum(const RingWake& w, const RingForce& blade, double u_mps) {
  constexpr double kFour_pi = 12.566370614359172;
  const double F = prandtl_loss(w.r_m, w.tip_m, w.root_m, w.blade_count, blade.sin_phi);
  const double k = kFour_pi * w.density_kgpm3 * w.r_m * w.dr_m * F;
  const double m = mass_flow_mps(u_mps, w.climb_mps, w.in_plane_mps, w.twist);
  // Where hardly any air flows, none can carry swirl away: bounded by a share of the blade's speed.
  const double most = 0.3 * std::abs(w.blade_speed_mps);
  const double swirl = w.swirl ? blade.drive_N / std::max(k * m, 1e-9) : 0.0;
  return {k * u_mps * m / induced_factor(w.induced_factor, u_mps, m), k * (m + std::abs(u_mps)),
          std::clamp(swirl, -most, most)};
}

struct RingPoint {
  double u_mps = 0.0;
  double v_mps = 0.0;
  bool converged = true;
};

// Thrust of the blade less that of the momentum at point.u_mps; settles point.v_mps.
template <typename ForceAt>
double imbalance_N(const RingWake& wake, const ForceAt& force_at, RingPoint& point) {
  double gap = 0.0;
  point.converged = false;
  for (int i = 0; i < 60; ++i) {
    const RingForce force = force_at(point.u_mps, point.v_mps);
    const RingMomentum m = ring_momentum(wake, force, point.u_mps);
    gap = force.thrust_N - m.thrust_N;
    const double step = m.swirl_mps - point.v_mps;
    if (std::abs(step) <= 1e-11 * (1.0 + std::abs(wake.blade_speed_mps))) {
      point.converged = true;
      break;
    }
    point.v_mps += (i < 8 ? 1.0 : i < 20 ? 0.5 : 0.2) * step;
  }
  return gap;
}

// Bisection where regula falsi (Illinois) does not halve the bracket by itself.
template <typename ForceAt>
RingPoint balance_ring(const RingWake& wake, const ForceAt& force_at, RingPoint start) {
  const double scale =
      1.0 + std::abs(wake.climb_mps) + wake.in_plane_mps + std::abs(wake.blade_speed_mps);
  RingPoint lo{-3.0 * scale, 0.0};
  RingPoint hi{3.0 * scale, 0.0};
  double f_lo = imbalance_N(wake, force_at, lo);
  double f_hi = imbalance_N(wake, force_at, hi);
  RingPoint mid = start;
  int side = 0;
  for (int i = 0; i < 200; ++i) {
    if (i == 1 || i % 3 == 0) {
      mid.u_mps =
          i == 0 ? std::clamp(start.u_mps, lo.u_mps, hi.u_mps) : 0.5 * (lo.u_mps + hi.u_mps);
    } else {
      mid.u_mps = (lo.u_mps * f_hi - hi.u_mps * f_lo) / (f_hi - f_lo);
    }
    const double f = imbalance_N(wake, force_at, mid);
    if (f == 0.0) return mid;
    if (hi.u_mps - lo.u_mps < 1e-12 * scale) break;
    if (f > 0.0) {
      lo = mid;
      f_lo = f;
      if (side == 1) f_hi *= 0.5;
      side = 1;
    } else {
      hi = mid;
      f_hi = f;
      if (side == -1) f_lo *= 0.5;
      side = -1;
    }
  }
  mid.converged = mid.converged && hi.u_mps - lo.u_mps < 1e-6 * scale;
  return mid;
}

}  // namespace whirl::plant
