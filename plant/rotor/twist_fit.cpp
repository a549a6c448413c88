#include "plant/rotor/twist_fit.hpp"

#include <cmath>

#include "plant/rotor/rotor.hpp"

namespace whirl::plant {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kMost_rad = 8.0 * kPi / 180.0;

// Summed thrust coefficient less the measured one; the blade must exist (checked by the caller).
double excess(PropellerDescription d, double twist_rad, const std::vector<StaticPoint>& points) {
  d.tip_twist_correction_rad = twist_rad;
  const auto blade = make_blade(d).value();
  double sum = 0.0;
  for (const StaticPoint& p : points) {
    sum += propeller_coefficients(blade, p.omega_radps, 0.0).CT - p.thrust_coefficient;
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
  if (auto blade = make_blade(d); !blade) return blade.error();
  if (points.empty()) {
    return Error{ErrorKind::bad_input, d.place, "no static thrust to fit the twist on",
                 "give rows of speed and thrust"};
  }
  double lo = -kMost_rad;
  double hi = kMost_rad;
  if (!(excess(d, lo, points) < 0.0 && excess(d, hi, points) > 0.0)) {
    return Error{ErrorKind::bad_input, d.place,
                 "static thrust is not met by any tip twist within 8 deg",
                 "check diameter, chord, angle and the unit of the thrust"};
  }
  while (hi - lo > 1e-4) {
    const double mid = 0.5 * (lo + hi);
    (excess(d, mid, points) < 0.0 ? lo : hi) = mid;
  }
  return 0.5 * (lo + hi);
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
