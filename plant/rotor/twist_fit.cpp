#include "plant/rotor/twist_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/angles.hpp"
#include "plant/rotor/blade_rings.hpp"
#include "plant/rotor/polar.hpp"
#include "plant/rotor/rotor.hpp"

namespace whirl::plant {
namespace {

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

bool beyond(double twist_rad) {
  const double deg = twist_rad / kDeg;
  return deg < kLowest_twist_deg - kRefused_beyond_deg - 1e-9 ||
         deg > kHighest_twist_deg + kRefused_beyond_deg + 1e-9;
}

std::string said(const char* format, double value) {
  char text[160];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

void add_left_over(const std::vector<StaticPoint>& points, TwistedBlade& made) {
  double thrust = 0.0, power = 0.0, thrust_off = 0.0, power_off = 0.0;
  for (const StaticPoint& p : points) {
    const auto k = propeller_coefficients(made.blade, p.omega_radps, 0.0);
    thrust += p.thrust_coefficient;
    thrust_off += std::abs(k.CT - p.thrust_coefficient);
    if (p.power_coefficient == 0.0) continue;
    power += p.power_coefficient;
    power_off += std::abs(k.CP - p.power_coefficient);
  }
  made.thrust_off = thrust > 0.0 ? thrust_off / thrust : 0.0;
  made.power_off = power > 0.0 ? power_off / power : 0.0;
}

}  // namespace

std::string twist_doubt(double twist_deg) {
  if (twist_deg >= kLowest_twist_deg && twist_deg <= kHighest_twist_deg) return "";
  return said("tip twist of %+.1f deg lies outside -1 to 4 deg: measure the angles again",
              twist_deg);
}

std::string answer_doubt(double share_per_deg) {
  if (share_per_deg >= kLeast_answer) return "";
  return said(
      "static thrust hardly answers to twist (%.1f %% per degree): the blade is stalled at rest, "
      "and its angles stay a guess",
      100.0 * share_per_deg);
}

std::string power_doubt(double share_left) {
  if (share_left <= kMost_left) return "";
  return said("static power is left over by %.0f %%: no section met thrust and power",
              100.0 * share_left);
}

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
  while (!beyond(far) && (excess(blade, far, points) < 0.0) == too_little) {
    near = far;
    far += step;
  }
  if (beyond(far)) {
    return Error{ErrorKind::bad_input, d.place,
                 "static thrust is not met by any tip twist from -3 to 6 deg",
                 "check diameter, chord, angle and the unit of the thrust"};
  }
  while (std::abs(far - near) > 1e-4) {
    const double mid = 0.5 * (near + far);
    ((excess(blade, mid, points) < 0.0) == too_little ? near : far) = mid;
  }
  return 0.5 * (near + far);
}

Result<TwistedBlade> make_fitted_blade(PropellerDescription d) {
  TwistedBlade made;
  made.found = !d.static_points.empty();
  if (made.found) {
    const auto twist = fit_tip_twist_rad(d, d.static_points);
    if (!twist) return twist.error();
    d.tip_twist_correction_rad = twist.value();
  }
  made.tip_twist_rad = d.tip_twist_correction_rad;
  made.description = d;
  const auto blade = make_blade(d);
  if (!blade) return blade.error();
  made.blade = blade.value();
  for (const SectionStation& s : d.sections) {
    made.drag_within = std::max(made.drag_within, s.polar->drag_within());
  }
  const auto doubt = [&made](const std::string& text) {
    if (!text.empty()) made.doubts.push_back(text);
  };
  doubt(twist_doubt(made.tip_twist_rad / kDeg));
  if (!made.found) return made;
  add_left_over(d.static_points, made);
  const double omega = d.static_points.back().omega_radps;
  made.answer_per_deg = propeller_coefficients(twisted(*made.blade, kDeg), omega, 0.0).CT /
                            propeller_coefficients(made.blade, omega, 0.0).CT -
                        1.0;
  doubt(answer_doubt(made.answer_per_deg));
  doubt(power_doubt(made.power_off));
  return made;
}

std::shared_ptr<const Blade> with_section_drag(const TwistedBlade& made, int side) {
  PropellerDescription d = made.description;
  for (SectionStation& s : d.sections) {
    s.polar = std::make_shared<const PolarFamily>(
        s.polar->with_drag(1.0 + side * s.polar->drag_within()));
  }
  return make_blade(d).value();
}

}  // namespace whirl::plant
