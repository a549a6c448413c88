#include "plant/rotor/blade_traits.hpp"

#include <algorithm>
#include <cmath>

#include "base/angles.hpp"

namespace whirl::plant {
namespace {

constexpr double kBend = 0.4;  // of the lift curve into its maximum
// Below it the flow that leaves the nose does not come back: seen as jumps of thrust over J that move with speed
// (docs/unseen_propellers.md). Of an attached lift.
constexpr double kStep_at = 0.7;      // at Re 60,000
constexpr double kStep_falls = 0.35;  // per ln Re
constexpr double kStep_width = 0.05;
constexpr double kLowest_lift = -0.6;
constexpr double kLow_bend = 0.1;
constexpr double kPlate = 1.25;     // drag of a plate across the flow, aspect ratio near 8
constexpr double kSeparated = 2.0;  // times the plate's drag, on the share of lift that is missing

double softplus(double z) {
  return z > 30.0 ? z : std::log1p(std::exp(z));
}

}  // namespace

TraitSection trait_section(const TraitVector& t, double chord_over_r, double reynolds) {
  const double level = std::log(std::clamp(reynolds, 5e3, 6e5) / 6e4);
  return {.slope_per_rad = std::exp(t[ln_lift_slope] + t[slope_power] * level),
          .zero_lift_rad = t[zero_lift_deg] * kDeg,
          .maximum = t[lift_maximum] * std::exp(t[maximum_power] * level),
          .step = t[lift_step],
          .step_at = kStep_at - kStep_falls * level,
          .least_drag = std::exp(t[ln_least_drag] - t[drag_power] * level),
          .rise = t[drag_rise],
          .delay = std::tanh(3.0 * chord_over_r * chord_over_r)};
}

SectionCoefficients coefficients(const TraitSection& s, double alpha) {
  const double size = std::abs(alpha) / kDeg;
  const double straight = s.slope_per_rad * std::sin(alpha - s.zero_lift_rad);
  const double above = std::clamp((straight - s.step_at) / kStep_width, -40.0, 40.0);
  const double attached = straight * (1.0 - s.step / (1.0 + std::exp(above)));
  double bent = s.maximum - kBend * softplus((s.maximum - attached) / kBend);
  bent = kLowest_lift + kLow_bend * softplus((bent - kLowest_lift) / kLow_bend);
  const double x = std::clamp((size - 20.0) / 25.0, 0.0, 1.0);
  const double fade = x * x * (3.0 - 2.0 * x);
  const double sine = std::sin(alpha);
  SectionCoefficients k;
  k.cl = bent + fade * (kPlate * sine * std::cos(alpha) - bent);
  const double missing =
      std::abs(attached) > 0.05 ? std::clamp((attached - k.cl) / attached, 0.0, 1.0) : 0.0;
  const double off = bent - 0.5;
  k.cd = s.least_drag + s.rise * off * off + kSeparated * missing * kPlate * sine * sine;
  k.cd += fade * (kPlate * sine * sine + s.least_drag - k.cd);
  if (k.cl < attached && alpha > s.zero_lift_rad) {
    k.cl += s.delay * std::clamp((50.0 - size) / 20.0, 0.0, 1.0) * (attached - k.cl);
  }
  return k;
}

double stall_angle_rad(const TraitSection& s) {
  return s.zero_lift_rad + std::asin(std::min(1.0, (s.maximum + kBend) / s.slope_per_rad));
}

double tip_twist_rad(const TraitVector& t, double nD_mps) {
  const double share = nD_mps / kTwist_speed_mps;
  return (t[tip_twist_deg] + t[speed_twist_deg] * share * share) * kDeg;
}

}  // namespace whirl::plant
