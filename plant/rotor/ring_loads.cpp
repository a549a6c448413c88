#include "plant/rotor/ring_loads.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace whirl::plant {
namespace {

constexpr double kPi = 3.14159265358979323846;
using Around = std::array<double, kAzimuths>;

struct Azimuths {
  Around c{};
  Around s{};
  Azimuths() {
    for (std::size_t k = 0; k < kAzimuths; ++k) {
      const double theta = 2.0 * kPi * static_cast<double>(k) / kAzimuths;
      c[k] = std::cos(theta);
      s[k] = std::sin(theta);
    }
  }
};
const Azimuths kAz;

struct Winds {
  Around tangential;
  Around axial;
};

Winds winds(const Ring& ring, const DiscFlow& f, double u, double v) {
  Winds w;
  const double r = ring.r_m;
  const double spin_speed = f.omega_radps * r - v;
  const double tilt = r / f.tip_radius_m;
  const double through = f.climb_mps + f.ground_factor * u;
  const double flap_speed = f.spin * f.omega_radps * r;
  for (std::size_t k = 0; k < kAzimuths; ++k) {
    const double c = kAz.c[k];
    const double s = kAz.s[k];
    const double beta = f.flap_rad.mean + f.flap_rad.c * c + f.flap_rad.s * s;
    w.tangential[k] = spin_speed + f.spin * (f.vx_mps * s - f.vy_mps * c);
    w.axial[k] = through + tilt * (f.tilt_inflow_mps.c * c + f.tilt_inflow_mps.s * s) -
                 r * (f.p_radps * s - f.q_radps * c) - beta * (f.vx_mps * c + f.vy_mps * s) +
                 flap_speed * (f.flap_rad.c * s - f.flap_rad.s * c);
  }
  return w;
}

}  // namespace

RingLoads ring_loads(const Ring& ring, const DiscFlow& f, double u, double v) {
  const Winds w = winds(ring, f, u, v);
  double speed2 = 0.0;
  for (std::size_t k = 0; k < kAzimuths; ++k) {
    speed2 += w.tangential[k] * w.tangential[k] + w.axial[k] * w.axial[k];
  }
  const double mean_speed = std::sqrt(speed2 / kAzimuths);
  const ReynoldsSlot slot =
      reynolds_slot(f.density_kgpm3 * mean_speed * ring.chord_m / f.viscosity_Pas);
  const double q_area =
      0.5 * f.density_kgpm3 * ring.chord_m * ring.dr_m * f.blade_count / kAzimuths;

  RingLoads sum;
  for (std::size_t k = 0; k < kAzimuths; ++k) {
    const double ut = w.tangential[k];
    const double up = w.axial[k];
    const double speed = std::sqrt(ut * ut + up * up);
    double alpha = ring.angle_rad - std::atan2(up, ut);
    if (alpha > kPi) alpha -= 2.0 * kPi;
    if (alpha < -kPi) alpha += 2.0 * kPi;
    const SectionCoefficients k2 = look_up(ring.table, slot, alpha);
    const double up_force = q_area * speed * (k2.cl * ut - k2.cd * up);
    const double back = q_area * speed * (k2.cl * up + k2.cd * ut);
    const double c = kAz.c[k];
    const double s = kAz.s[k];
    const double beta = f.flap_rad.mean + f.flap_rad.c * c + f.flap_rad.s * s;
    sum.thrust_N += up_force;
    sum.drive_N += back;
    sum.fx_N += -back * f.spin * s - beta * up_force * c;
    sum.fy_N += back * f.spin * c - beta * up_force * s;
    sum.lift_N.c += up_force * c;
    sum.lift_N.s += up_force * s;
    sum.stalled += (std::abs(alpha) > ring.stall_alpha_rad ? 1.0 : 0.0) / kAzimuths;
  }
  sum.lift_N.mean = sum.thrust_N;
  const double through = f.climb_mps + f.ground_factor * u;
  sum.sin_phi = through / std::max(mean_speed, 1e-6);
  sum.lift_slope_N_per_mps = q_area * kAzimuths * mean_speed * 2.0 * kPi;
  return sum;
}

}  // namespace whirl::plant
