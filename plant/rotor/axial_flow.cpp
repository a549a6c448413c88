#include "plant/rotor/axial_flow.hpp"

#include <algorithm>
#include <cmath>

#include "base/angles.hpp"
#include "plant/rotor/ring_balance.hpp"

namespace whirl::plant {
namespace {

constexpr double kDensity_kgpm3 = 1.225;
constexpr double kViscosity_Pas = 1.81e-5;

// One ring; W is the speed of the air at the blade, phi its angle against the disc.
struct RingState {
  double W_mps = 0.0;
  double sin_phi = 0.0;
  double cos_phi = 1.0;
  SectionCoefficients k;
};

struct RingProblem {
  TraitSection section;
  double angle_rad, r_m, chord_m, turning_mps, climb_mps, hover_loss;
  double tip_m, hub_m;
  int count;

  // Inflow that the blade leaves over what momentum gives, at this inflow angle; rises with it.
  double excess(double phi, RingState& s) const {
    s.sin_phi = std::sin(phi);
    s.cos_phi = std::cos(phi);
    s.k = coefficients(section, angle_rad - phi);
    const double sine = std::max(s.sin_phi, 1e-6);
    const double up = s.k.cl * s.cos_phi - s.k.cd * s.sin_phi;
    const double back = s.k.cl * s.sin_phi + s.k.cd * s.cos_phi;
    const double h =
        count * chord_m / (8.0 * kPi * r_m * prandtl_loss(r_m, tip_m, hub_m, count, s.sin_phi));
    s.W_mps = turning_mps / (s.cos_phi + h * back / sine);
    if (s.W_mps < 0.0) s.W_mps = turning_mps;
    const double through = s.W_mps * s.sin_phi;
    const double factor =
        through > 0.0 ? induced_factor(hover_loss, through - climb_mps, through) : hover_loss;
    return through - climb_mps - s.W_mps * h * up * factor / sine;
  }
};

RingState solve(const RingProblem& ring) {
  RingState s;
  double low = 1e-4;
  double high = std::max(ring.angle_rad + 0.3, 0.3);
  double at_low = ring.excess(low, s);
  double at_high = ring.excess(high, s);
  if (at_low > 0.0) low = -0.3;
  int side = 0;
  for (int i = 0; i < 40; ++i) {
    double phi = (low * at_high - high * at_low) / (at_high - at_low);
    if (i % 4 == 3 || !(phi > low && phi < high)) phi = 0.5 * (low + high);
    const double f = ring.excess(phi, s);
    if (std::abs(f) < 1e-6 * ring.turning_mps || high - low < 1e-9) break;
    if (f < 0.0) {
      low = phi, at_low = f;
      if (side == 1) at_high *= 0.5;
      side = 1;
    } else {
      high = phi, at_high = f;
      if (side == -1) at_low *= 0.5;
      side = -1;
    }
  }
  return s;
}

}  // namespace

AxialBlade axial_blade(const PropellerDescription& d, int rings) {
  AxialBlade blade{d.blade_count, 0.5 * d.diameter_m, 0.0, {}};
  const double root = std::max(std::min(d.stations.front().r_over_R, 0.15), 0.05);
  blade.hub_over_R = 0.5 * root;
  const double width = (1.0 - root) / rings;
  for (int i = 0; i < rings; ++i) {
    const double x = root + (i + 0.5) * width;
    blade.rings.push_back({x, width, station_value(d.stations, x, &PropellerStation::c_over_R),
                           station_value(d.stations, x, &PropellerStation::angle_rad)});
  }
  return blade;
}

PropellerCoefficients axial_coefficients(const AxialBlade& blade, const TraitVector& traits,
                                         double omega_radps, double advance_ratio) {
  const double n = omega_radps / (2.0 * kPi);
  const double D = 2.0 * blade.radius_m;
  const double climb = advance_ratio * n * D;
  const double twist = tip_twist_rad(traits, n * D);
  double thrust = 0.0;
  double torque = 0.0;
  for (const AxialRing& ring : blade.rings) {
    const double r = ring.r_over_R * blade.radius_m;
    const double c = ring.c_over_R * blade.radius_m;
    const double turning = omega_radps * r;
    const double reynolds = kDensity_kgpm3 * std::hypot(turning, climb) * c / kViscosity_Pas;
    const RingState s = solve({.section = trait_section(traits, c / r, reynolds),
                               .angle_rad = ring.angle_rad + twist * ring.r_over_R,
                               .r_m = r,
                               .chord_m = c,
                               .turning_mps = turning,
                               .climb_mps = climb,
                               .hover_loss = traits[hover_loss],
                               .tip_m = blade.radius_m,
                               .hub_m = blade.hub_over_R * blade.radius_m,
                               .count = blade.count});
    const double q = 0.5 * kDensity_kgpm3 * s.W_mps * s.W_mps * blade.count * c * ring.dr_over_R *
                     blade.radius_m;
    thrust += q * (s.k.cl * s.cos_phi - s.k.cd * s.sin_phi);
    torque += q * (s.k.cl * s.sin_phi + s.k.cd * s.cos_phi) * r;
  }
  const double scale = kDensity_kgpm3 * n * n * std::pow(D, 4);
  return {thrust / scale, torque * omega_radps / (scale * n * D)};
}

}  // namespace whirl::plant
