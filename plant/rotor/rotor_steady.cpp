// The steady solution: every ring's balance by bracketing, around it the disc's first harmonics.
//
//   Converges  blade thrust falls and momentum thrust rises with the induced velocity u, and the
//              second is unbounded, so a bracket always closes; the harmonics are relaxed.
#include <algorithm>
#include <cmath>

#include "plant/rotor/rotor_state.hpp"

namespace whirl::plant {
namespace {

struct RingPoint {
  double u = 0.0;
  double v = 0.0;
};

// Thrust of the blade less that of the momentum at u, with the swirl settled to match.
double imbalance(const Blade& blade, const Ring& ring, const DiscFlow& flow, RingPoint& point) {
  double gap = 0.0;
  for (int i = 0; i < 30; ++i) {
    const RingLoads loads = ring_loads(ring, flow, point.u, point.v);
    const RingMomentum m = ring_momentum(blade, ring, flow, loads, point.u);
    gap = loads.thrust_N - m.thrust_N;
    const double step = m.swirl_mps - point.v;
    point.v += (i < 10 ? 1.0 : 0.5) * step;
    if (std::abs(step) < 1e-10 * (1.0 + std::abs(point.v))) break;
  }
  return gap;
}

// Illinois regula falsi: keeps the bracket, converges faster than bisection.
RingPoint solve_ring(const Blade& blade, const Ring& ring, const DiscFlow& flow, RingPoint start) {
  const double scale = 1.0 + std::abs(flow.climb_mps) + std::hypot(flow.vx_mps, flow.vy_mps) +
                       std::abs(flow.omega_radps) * ring.r_m;
  RingPoint lo{-2.0 * scale, 0.0};
  RingPoint hi{2.0 * scale, 0.0};
  double f_lo = imbalance(blade, ring, flow, lo);
  double f_hi = imbalance(blade, ring, flow, hi);
  RingPoint mid = start;
  int side = 0;
  for (int i = 0; i < 200; ++i) {
    if (i > 0) {
      mid.u = i % 4 == 3 ? 0.5 * (lo.u + hi.u) : (lo.u * f_hi - hi.u * f_lo) / (f_hi - f_lo);
    }
    mid.u = std::clamp(mid.u, lo.u, hi.u);
    const double f = imbalance(blade, ring, flow, mid);
    if (f == 0.0) break;
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
    if (hi.u - lo.u < 1e-10 * scale || std::abs(f) < 1e-14 * (std::abs(f_lo) + std::abs(f_hi)))
      break;
  }
  return mid;
}

double distance(const Harmonic& a, const Harmonic& b) {
  return std::abs(a.mean - b.mean) + std::abs(a.c - b.c) + std::abs(a.s - b.s);
}

void relax(Harmonic& state, const Harmonic& wanted, double share) {
  state.mean += share * (wanted.mean - state.mean);
  state.c += share * (wanted.c - state.c);
  state.s += share * (wanted.s - state.s);
}

}  // namespace

RotorLoads Rotor::steady(const RotorConditions& conditions) const {
  RotorValidity validity;
  DiscFlow flow = disc_flow(*blade_, spin_sign_, conditions, validity);
  std::array<double, kRing_count> u = state_->u_mps;
  std::array<double, kRing_count> v{};
  DiscLoads disc;
  const double small = 1e-7 * (1.0 + std::abs(flow.omega_radps) * blade_->radius_m);
  validity.not_converged = true;
  for (int i = 0; i < 60; ++i) {
    for (std::size_t k = 0; k < kRing_count; ++k) {
      const RingPoint p = solve_ring(*blade_, blade_->rings[k], flow, {u[k], v[k]});
      u[k] = p.u;
      v[k] = p.v;
    }
    disc = disc_loads(*blade_, flow, u, v);
    const Harmonic tilt = wanted_tilt(*blade_, flow, disc);
    const Harmonic flap = wanted_flap(*blade_, flow, disc);
    const bool settled =
        distance(tilt, flow.tilt_inflow_mps) < small && distance(flap, flow.flap_rad) < 1e-7;
    if (settled) {
      validity.not_converged = false;
      break;
    }
    relax(flow.tilt_inflow_mps, tilt, 0.5);
    relax(flow.flap_rad, flap, 0.7);
  }
  return airframe_loads(*blade_, flow, disc, validity);
}

}  // namespace whirl::plant
