// The steady solution: every ring's balance by bracketing, around it the disc's first harmonics.
//
//   Converges  blade thrust falls and momentum thrust rises with the induced velocity u, and the
//              second is unbounded, so a bracket always closes; the harmonics are relaxed.
#include <algorithm>
#include <cmath>

#include "plant/rotor/rotor_state.hpp"
#include "plant/rotor/torsion.hpp"

namespace whirl::plant {
namespace {

RingPoint solve_ring(const Blade& blade, const Ring& ring, const DiscFlow& flow, RingPoint start) {
  const auto force_at = [&](double u, double v) {
    RingLoads l;
    ring_loads(ring, flow, u, v, l);
    return RingForce{l.thrust_N, l.drive_N, l.sin_phi};
  };
  return balance_ring(ring_wake(blade, ring, flow), force_at, start);
}

double distance(const Harmonic& a, const Harmonic& b) {
  return std::abs(a.c - b.c) + std::abs(a.s - b.s);
}

void relax(Harmonic& state, const Harmonic& wanted, double share) {
  state.mean = wanted.mean;
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
  for (int i = 0; i < 80; ++i) {
    bool rings_converged = true;
    for (std::size_t k = 0; k < kRing_count; ++k) {
      const RingPoint p = solve_ring(*blade_, blade_->rings[k], flow, {u[k], v[k]});
      u[k] = p.u_mps;
      v[k] = p.v_mps;
      rings_converged = rings_converged && p.converged;
    }
    disc = disc_loads(*blade_, flow, u, v);
    const Harmonic tilt = wanted_tilt(*blade_, flow, disc);
    const Harmonic flap = wanted_flap(*blade_, flow, disc);
    const double twist = wanted_tip_twist_rad(*blade_, flow, disc);
    const bool settled = distance(tilt, flow.tilt_inflow_mps) < small &&
                         distance(flap, flow.flap_rad) < 1e-7 &&
                         std::abs(twist - flow.tip_twist_rad) < 1e-7;
    if (settled) {
      validity.not_converged = !rings_converged;
      break;
    }
    relax(flow.tilt_inflow_mps, tilt, 0.5);
    relax(flow.flap_rad, flap, 0.7);
    flow.tip_twist_rad += 0.7 * (twist - flow.tip_twist_rad);
  }
  return airframe_loads(*blade_, flow, disc, validity);
}

}  // namespace whirl::plant
