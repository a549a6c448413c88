#include "plant/rotor/rotor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "plant/rotor/rotor_state.hpp"
#include "plant/rotor/torsion.hpp"

namespace whirl::plant {
namespace {

// Apparent mass of a ring of air, as share of rho R dA [PittPeters, uniform part].
constexpr double kApparent_mass = 8.0 / (3.0 * kPi);

}  // namespace

Rotor::Rotor(std::shared_ptr<const Blade> blade, int spin_sign)
    : blade_(std::move(blade)), spin_sign_(spin_sign), state_(std::make_unique<State>()) {
  WHIRL_CHECK(blade_ != nullptr);
  WHIRL_CHECK(spin_sign == 1 || spin_sign == -1, spin_sign);
}
Rotor::~Rotor() = default;
Rotor::Rotor(Rotor&&) noexcept = default;
Rotor& Rotor::operator=(Rotor&&) noexcept = default;

RotorLoads Rotor::step(const RotorConditions& conditions, double dt_s) {
  WHIRL_CHECK(dt_s > 0.0 && dt_s < 1.0, dt_s);
  State& s = *state_;
  RotorValidity validity;
  DiscFlow flow = disc_flow(*blade_, spin_sign_, conditions, validity);
  flow.tilt_inflow_mps = s.tilt_mps;
  flow.flap_rad = s.flap_rad;
  flow.tip_twist_rad = s.tip_twist_rad;
  const DiscLoads disc = disc_loads(*blade_, flow, s.u_mps, s.v_mps);

  RingWake wake = ring_wake(*blade_, blade_->rings[0], flow);
  for (std::size_t i = 0; i < kRing_count; ++i) {
    const Ring& ring = blade_->rings[i];
    const RingLoads& loads = disc.rings[i];
    wake.r_m = ring.r_m;
    wake.dr_m = ring.dr_m;
    wake.blade_speed_mps = flow.omega_radps * ring.r_m;
    const RingMomentum m =
        ring_momentum(wake, {loads.thrust_N, loads.drive_N, loads.sin_phi}, s.u_mps[i]);
    const double mass =
        kApparent_mass * flow.density_kgpm3 * blade_->radius_m * 2.0 * kPi * ring.r_m * ring.dr_m;
    // Linearly implicit Euler: stable for any step, and its rest point is the balance itself.
    const double stiffness = m.slope_N_per_mps + loads.lift_slope_N_per_mps;
    s.u_mps[i] += dt_s * (loads.thrust_N - m.thrust_N) / (mass + dt_s * stiffness);
    const double tau = mass / std::max(stiffness, 1e-9);
    s.v_mps[i] += dt_s / (dt_s + tau) * (m.swirl_mps - s.v_mps[i]);
  }
  const Harmonic tilt = wanted_tilt(*blade_, flow, disc);
  const double w = dt_s / (dt_s + tilt_time_constant_s(*blade_, flow, disc));
  s.tilt_mps.c += w * (tilt.c - s.tilt_mps.c);
  s.tilt_mps.s += w * (tilt.s - s.tilt_mps.s);
  const Harmonic flap = wanted_flap(*blade_, flow, disc);
  constexpr double kFlap_lag_s = 2e-3;  // about the period of a slow-fly blade's first bending
  const double f = dt_s / (dt_s + kFlap_lag_s);
  s.tip_twist_rad += f * (wanted_tip_twist_rad(*blade_, flow, disc) - s.tip_twist_rad);
  s.flap_rad.mean += f * (flap.mean - s.flap_rad.mean);
  s.flap_rad.c += f * (flap.c - s.flap_rad.c);
  s.flap_rad.s += f * (flap.s - s.flap_rad.s);
  return airframe_loads(*blade_, flow, disc, validity);
}

}  // namespace whirl::plant
