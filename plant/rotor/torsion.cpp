#include "plant/rotor/torsion.hpp"

#include <algorithm>
#include <cmath>

#include "base/angles.hpp"
#include "plant/rotor/rotor_state.hpp"

namespace whirl::plant {
namespace {

constexpr double kMostTwist_rad = 8.0 * kPi / 180.0;
constexpr double kTorsion_constant = 0.152;  // over c t^3
constexpr double kFlat_inertia = 0.033;  // section's second moment in the chord's sense, over c^3 t
constexpr double kLift_arm = 0.45 - 0.25;  // over chord: elastic axis behind the quarter point

}  // namespace

std::array<double, kRing_count> thickness_m(const Blade& blade, double over_chord) {
  std::size_t widest = 0;
  for (std::size_t i = 1; i < kRing_count; ++i) {
    if (blade.rings[i].chord_m > blade.rings[widest].chord_m) widest = i;
  }
  const Ring& wide = blade.rings[widest];
  const double most = over_chord * wide.chord_m;
  std::array<double, kRing_count> t;
  for (std::size_t i = 0; i < kRing_count; ++i) {
    const Ring& ring = blade.rings[i];
    t[i] = i < widest ? most * (2.0 - ring.r_m / wide.r_m)
                      : std::max(over_chord * ring.chord_m, 0.4 * most);
  }
  return t;
}

void fill_torsion(const BladeMaterial& material, double over_chord, Blade& blade) {
  if (!(material.shear_modulus_Pa > 0.0)) return;
  const auto t = thickness_m(blade, over_chord);
  std::array<double, kRing_count> slope;  // of the twist under the reference load
  std::array<double, kRing_count> rigidity;
  double moment = 0.0;
  for (std::size_t i = kRing_count; i-- > 0;) {
    const Ring& ring = blade.rings[i];
    const double load = ring.r_m * ring.r_m * ring.chord_m * ring.chord_m * ring.dr_m;
    rigidity[i] = material.shear_modulus_Pa * kTorsion_constant * ring.chord_m * t[i] * t[i] * t[i];
    slope[i] = (moment + 0.5 * load) / rigidity[i];
    moment += load;
  }
  double tip = 0.0;
  for (std::size_t i = 0; i < kRing_count; ++i) tip += slope[i] * blade.rings[i].dr_m;
  double at = 0.0;
  double stiffness = 0.0;
  Torsion& torsion = blade.torsion;
  for (std::size_t i = 0; i < kRing_count; ++i) {
    Ring& ring = blade.rings[i];
    const double half = 0.5 * slope[i] * ring.dr_m / tip;
    ring.twist_share = at + half;
    at += 2.0 * half;
    stiffness += rigidity[i] * slope[i] * slope[i] / (tip * tip) * ring.dr_m;
    torsion.lift_arm_m[i] = ring.twist_share * kLift_arm * ring.chord_m / blade.count;
    torsion.camber_m3[i] =
        ring.twist_share * 0.5 * kPi * ring.zero_lift_rad * ring.chord_m * ring.chord_m * ring.dr_m;
    torsion.flat_kgm2[i] = ring.twist_share * material.density_kgpm3 * kFlat_inertia *
                           std::pow(ring.chord_m, 3) * t[i] * ring.dr_m;
  }
  settle_flattening(blade);
  torsion.compliance_rad_per_Nm = 1.0 / stiffness;
}

void settle_flattening(Blade& blade) {
  blade.torsion.flattening_kgm2 = blade.torsion.given_kgm2;
  for (std::size_t i = 0; i < kRing_count; ++i) {
    const double angle = blade.rings[i].angle_rad;
    blade.torsion.flattening_kgm2 += blade.torsion.flat_kgm2[i] * std::sin(angle) * std::cos(angle);
  }
}

double wanted_tip_twist_rad(const Blade& blade, const DiscFlow& f, const DiscLoads& disc) {
  const Torsion& torsion = blade.torsion;
  if (torsion.compliance_rad_per_Nm == 0.0) return 0.0;
  const double w2 = f.omega_radps * f.omega_radps;
  double moment = -torsion.flattening_kgm2 * w2;
  const double head = f.climb_mps * f.climb_mps + 0.5 * (f.vx_mps * f.vx_mps + f.vy_mps * f.vy_mps);
  for (std::size_t i = 0; i < kRing_count; ++i) {
    const double r = blade.rings[i].r_m;
    moment += torsion.lift_arm_m[i] * disc.rings[i].thrust_N +
              0.5 * f.density_kgpm3 * (w2 * r * r + head) * torsion.camber_m3[i];
  }
  return std::clamp(torsion.compliance_rad_per_Nm * moment, -kMostTwist_rad, kMostTwist_rad);
}

}  // namespace whirl::plant
