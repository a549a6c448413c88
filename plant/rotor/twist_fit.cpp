#include "plant/rotor/twist_fit.hpp"

#include <cmath>

#include "base/angles.hpp"
#include "plant/rotor/blade_rings.hpp"
#include "plant/rotor/rotor.hpp"

namespace whirl::plant {
namespace {

constexpr double kMost_rad = 8.0 * kPi / 180.0;

constexpr double kScan_rad = 0.5 * kPi / 180.0;

// Summed thrust coefficient of the blade, turned further by `twist_rad`, less the measured one.
double excess(const Blade& blade, double twist_rad, const std::vector<StaticPoint>& points) {
  const auto turned = twisted(blade, twist_rad);
  double sum = 0.0;
  for (const StaticPoint& p : points) {
    sum += propeller_coefficients(turned, p.omega_radps, 0.0).CT - p.thrust_coefficient;
  }
  return sum;
}

}  // namespace

PropellerCoefficients propeller_coefficients(const std::shared_ptr<const Blade>& blade,
                                             double omega_radps, double advance_ratio) {
  const double n = omega_radps / (2.0 * kPi);
  const double D = 2.0 * radius_m(*blade);
  RotorConditions c;
  c.omega_radps = omega_radps;
  c.v_AP_P_mps.z() = -advance_ratio * n * D;
  const RotorLoads loads = Rotor(blade, 1).steady(c);
  const double scale = c.density_kgpm3 * n * n * std::pow(D, 4);
  return {loads.thrust_N / scale, loads.shaft_power_W / (scale * n * D)};
}

Result<double> fit_tip_twist_rad(PropellerDescription d, const std::vector<StaticPoint>& points) {
  d.tip_twist_correction_rad = 0.0;
  const auto made = make_blade(d);
  if (!made) return made.error();
  if (points.empty()) {
    return Error{ErrorKind::bad_input, d.place, "no static thrust to fit the twist on",
                 "give rows of speed and thrust"};
  }
  const Blade& blade = *made.value();
  // Outward from the given angles: beyond stall a second twist may give the same thrust.
  const bool too_little = excess(blade, 0.0, points) < 0.0;
  const double step = too_little ? kScan_rad : -kScan_rad;
  double near = 0.0;
  double far = step;
  while (std::abs(far) <= kMost_rad && (excess(blade, far, points) < 0.0) == too_little) {
    near = far;
    far += step;
  }
  if (std::abs(far) > kMost_rad) {
    return Error{ErrorKind::bad_input, d.place,
                 "static thrust is not met by any tip twist within 8 deg",
                 "check diameter, chord, angle and the unit of the thrust"};
  }
  while (std::abs(far - near) > 1e-4) {
    const double mid = 0.5 * (near + far);
    ((excess(blade, mid, points) < 0.0) == too_little ? near : far) = mid;
  }
  return 0.5 * (near + far);
}

Result<std::shared_ptr<const Blade>> make_fitted_blade(PropellerDescription d) {
  if (!d.static_points.empty()) {
    const auto twist = fit_tip_twist_rad(d, d.static_points);
    if (!twist) return twist.error();
    d.tip_twist_correction_rad = twist.value();
  }
  return make_blade(d);
}

}  // namespace whirl::plant
