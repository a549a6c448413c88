// Sums over the rings and the momentum side of the balance; see rotor_state.hpp.
//
//   Source  ring mass flow: momentum.hpp. Gradient: steady gains of [PittPeters] (first harmonics).
//           Ground: [Hayden], flight tests of many helicopters: induced power at a thrust over that far
//           from the ground = 1 / (0.9926 + 0.0379 (2R/z)^2), about twice what the potential flow of
//           [CheesemanBennett] says; measured above z = R/2, no pole below it.
#include <algorithm>
#include <cmath>

#include "base/angles.hpp"
#include "plant/rotor/momentum.hpp"
#include "plant/rotor/rotor_state.hpp"

namespace whirl::plant {
namespace {

constexpr double kMost_speed_mps = 120.0;
constexpr double kMost_tip_speed_mps = 300.0;

double bounded(double x, double most, bool& clamped) {
  if (!(std::abs(x) <= most)) {
    clamped = true;
    return std::isfinite(x) ? std::copysign(most, x) : 0.0;
  }
  return x;
}

struct Wake {
  double mass_flow_mps = 0.0;
  double along_mps = 0.0;  // through the disc
  double in_plane_mps = 0.0;
};

double in_plane_mps(const DiscFlow& f) {
  return std::sqrt(f.vx_mps * f.vx_mps + f.vy_mps * f.vy_mps);
}

Wake mean_wake(const DiscFlow& f, const DiscLoads& disc) {
  Wake w;
  w.along_mps = f.climb_mps + disc.induced_mps;
  w.in_plane_mps = in_plane_mps(f);
  w.mass_flow_mps = mass_flow_mps(disc.induced_mps, f.climb_mps, w.in_plane_mps);
  return w;
}

double ground_factor(const RotorConditions& c, double R, bool& out_of_range) {
  if (!(c.height_m < 20.0 * R)) return 1.0;
  out_of_range = out_of_range || c.height_m < 0.0;
  const double x = 2.0 * R / std::max(c.height_m, 0.1 * R);
  return std::min(1.0, 1.0 / (0.9926 + 0.0379 * x * x));
}

}  // namespace

DiscFlow disc_flow(const Blade& blade, int spin, const RotorConditions& c,
                   RotorValidity& validity) {
  DiscFlow f;
  bool& clamped = validity.out_of_range;
  const double R = blade.radius_m;
  f.spin = spin;
  f.vx_mps = bounded(c.v_AP_P_mps.x(), kMost_speed_mps, clamped);
  f.vy_mps = bounded(c.v_AP_P_mps.y(), kMost_speed_mps, clamped);
  f.climb_mps = -bounded(c.v_AP_P_mps.z(), kMost_speed_mps, clamped);
  f.p_radps = bounded(c.w_WP_P_radps.x(), 100.0, clamped);
  f.q_radps = bounded(c.w_WP_P_radps.y(), 100.0, clamped);
  const double yaw = bounded(c.w_WP_P_radps.z(), 100.0, clamped);
  const double omega = bounded(c.omega_radps, kMost_tip_speed_mps / R, clamped);
  validity.backward = omega < 0.0;
  f.omega_radps = omega - spin * yaw;
  f.density_kgpm3 = std::max(bounded(c.density_kgpm3, 5.0, clamped), 1e-3);
  f.viscosity_Pas = std::max(bounded(c.viscosity_Pas, 1e-3, clamped), 1e-6);
  f.tip_radius_m = R;
  f.blade_count = blade.count;
  f.ground_factor = ground_factor(c, R, clamped);
  const double tip_speed = std::abs(f.omega_radps) * R;
  const double in_plane = in_plane_mps(f);
  validity.beyond_advance_ratio = in_plane > 0.3 * tip_speed && in_plane > 0.5;
  return f;
}

DiscLoads disc_loads(const Blade& blade, const DiscFlow& flow,
                     const std::array<double, kRing_count>& u,
                     const std::array<double, kRing_count>& v) {
  DiscLoads d;
  double weight = 0.0;
  double speed2 = 0.0;
  for (std::size_t i = 0; i < kRing_count; ++i) {
    const Ring& ring = blade.rings[i];
    ring_loads(ring, flow, u[i], v[i], d.rings[i]);
    const RingLoads& l = d.rings[i];
    d.thrust_N += l.thrust_N;
    d.torque_Nm += l.drive_N * ring.r_m;
    d.fx_N += l.fx_N;
    d.fy_N += l.fy_N;
    d.moment_c_Nm += l.lift_N.c * ring.r_m;
    d.moment_s_Nm += l.lift_N.s * ring.r_m;
    d.moment_mean_Nm += l.lift_N.mean * ring.r_m;
    d.stalled += l.stalled * ring.r_m * ring.r_m;
    speed2 += ring.r_m * ring.r_m;
    d.induced_mps += u[i] * ring.r_m * ring.dr_m;
    weight += ring.r_m * ring.dr_m;
  }
  d.induced_mps /= weight;
  d.stalled /= speed2;
  return d;
}

RotorLoads airframe_loads(const Blade& blade, const DiscFlow& f, const DiscLoads& d,
                          RotorValidity validity) {
  RotorLoads out;
  out.thrust_N = d.thrust_N;
  out.f_P_N = {d.fx_N, d.fy_N, -d.thrust_N};
  out.tau_P_Nm = {-d.moment_s_Nm, d.moment_c_Nm, f.spin * d.torque_Nm};
  out.shaft_torque_Nm = d.torque_Nm;
  out.shaft_power_W = d.torque_Nm * f.omega_radps;
  out.induced_velocity_mps = d.induced_mps;
  out.flap_rad = {f.flap_rad.mean, f.flap_rad.c, f.flap_rad.s};
  if (d.thrust_N > 0.0 && out.shaft_power_W > 0.0) {
    const double ideal = std::sqrt(d.thrust_N * d.thrust_N * d.thrust_N /
                                   (2.0 * f.density_kgpm3 * kPi * blade.radius_m * blade.radius_m));
    out.figure_of_merit = ideal / out.shaft_power_W;
  }
  out.validity = validity;
  out.validity.stalled = d.stalled > 1.0 / 3.0;
  const double u = d.induced_mps;
  const double xi = u == 0.0 ? 0.0 : f.climb_mps / u;
  out.validity.vortex_ring = xi < 0.0 && xi > -2.0 && in_plane_mps(f) < std::abs(u);
  return out;
}

namespace {

// Of the twelve degrees that were measured; what has more is not told apart.
double twist_share(const Blade& blade) {
  constexpr double kPer_rad = 180.0 / (12.0 * kPi);
  const double twist = blade.rings[2].angle_rad - blade.rings[kRing_count - 2].angle_rad;
  return std::clamp(twist * kPer_rad, 0.0, 1.0);
}

}  // namespace

RingWake ring_wake(const Blade& blade, const Ring& ring, const DiscFlow& f) {
  return {.r_m = ring.r_m,
          .dr_m = ring.dr_m,
          .density_kgpm3 = f.density_kgpm3,
          .climb_mps = f.climb_mps,
          .in_plane_mps = in_plane_mps(f),
          .blade_speed_mps = f.omega_radps * ring.r_m,
          .blade_count = blade.count,
          .tip_m = blade.radius_m,
          .root_m = blade.hub_m,
          .swirl = true,
          .induced_factor = blade.induced_factor,
          .twist = twist_share(blade)};
}

Harmonic wanted_tilt(const Blade& blade, const DiscFlow& f, const DiscLoads& d) {
  const Wake w = mean_wake(f, d);
  const double along_mps = std::abs(w.along_mps) + 1e-9;
  const double speed = std::sqrt(w.in_plane_mps * w.in_plane_mps + along_mps * along_mps);
  const double cos_skew = along_mps / speed;
  const double tan_half_skew = w.in_plane_mps / (speed + along_mps);
  const double wx = w.in_plane_mps > 1e-9 ? -f.vx_mps / w.in_plane_mps : 1.0;  // downstream
  const double wy = w.in_plane_mps > 1e-9 ? -f.vy_mps / w.in_plane_mps : 0.0;
  const double per_moment = 1.0 / std::max(f.density_kgpm3 * kPi * blade.radius_m * blade.radius_m *
                                               blade.radius_m * w.mass_flow_mps,
                                           1e-9);
  const double along = d.moment_c_Nm * wx + d.moment_s_Nm * wy;
  const double across = -d.moment_c_Nm * wy + d.moment_s_Nm * wx;
  const double fore_aft = 15.0 * kPi / 32.0 * tan_half_skew * d.induced_mps +
                          4.0 * cos_skew / (1.0 + cos_skew) * along * per_moment;
  const double lateral = 4.0 / (1.0 + cos_skew) * across * per_moment;
  const double most = 2.0 * std::abs(d.induced_mps) + 1.0;
  const double a = std::clamp(fore_aft, -most, most);
  const double b = std::clamp(lateral, -most, most);
  return {0.0, a * wx - b * wy, a * wy + b * wx};
}

double tilt_time_constant_s(const Blade& blade, const DiscFlow& f, const DiscLoads& d) {
  const Wake w = mean_wake(f, d);
  return 32.0 / (45.0 * kPi) * blade.radius_m / std::max(w.mass_flow_mps, 0.1);
}

// Quasi-steady: the blade's own frequency lies far above once per revolution.
Harmonic wanted_flap(const Blade& blade, const DiscFlow& f, const DiscLoads& d) {
  const double I = blade.flap_inertia_kgm2;
  const double w2 = f.omega_radps * f.omega_radps;
  const double B = blade.count;
  const double k = blade.flap_stiffness_Nm_per_rad;
  // A body rate asks each blade to change its plane: gyroscopic flap moment 2 I w (p, q) terms.
  const double gyro = 2.0 * I * f.omega_radps * f.spin;
  const double gyro_c = -gyro * f.p_radps;
  const double gyro_s = -gyro * f.q_radps;
  return {d.moment_mean_Nm / B / (k + I * w2), (2.0 * d.moment_c_Nm / B + gyro_c) / k,
          (2.0 * d.moment_s_Nm / B + gyro_s) / k};
}

}  // namespace whirl::plant
