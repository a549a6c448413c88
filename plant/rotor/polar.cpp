#include "plant/rotor/polar.hpp"

#include <algorithm>
#include <cmath>

#include "base/angles.hpp"
#include "base/check.hpp"

namespace whirl::plant {
namespace {

constexpr double kDrag_at_90 = 1.11 + 0.018 * 8.0;  // slow-fly blades: aspect ratio near 8
constexpr double kSkin_friction = 0.02;

// A separated plate; Viterna's continuation turns into it at 90 deg.
SectionCoefficients plate(double alpha) {
  const double s = std::sin(alpha);
  return {kDrag_at_90 * s * std::cos(alpha), kDrag_at_90 * s * s + kSkin_friction};
}

// From the last row to 90 deg, continuous there. Beyond 90 deg (flow from behind): the plate.
SectionCoefficients beyond(const PolarRow& last, double alpha) {
  const double s0 = std::sin(last.alpha_rad);
  const double c0 = std::cos(last.alpha_rad);
  const double c = std::cos(alpha);
  SectionCoefficients k = plate(alpha);
  if (c <= 0.0 || c0 <= 0.0 || s0 == 0.0) return k;
  const SectionCoefficients there = plate(last.alpha_rad);
  const double s = std::sin(alpha);
  k.cl += (last.cl - there.cl) * (s0 / s) * (c * c) / (c0 * c0);
  k.cd += (last.cd - there.cd) * c / c0;
  k.cd = std::max(k.cd, 0.5 * kSkin_friction);
  return k;
}

SectionCoefficients on_curve(const PolarCurve& curve, double alpha_rad) {
  const auto& rows = curve.rows;
  if (alpha_rad <= rows.front().alpha_rad) return beyond(rows.front(), alpha_rad);
  if (alpha_rad >= rows.back().alpha_rad) return beyond(rows.back(), alpha_rad);
  const auto above =
      std::upper_bound(rows.begin(), rows.end(), alpha_rad,
                       [](double alpha, const PolarRow& row) { return alpha < row.alpha_rad; });
  const PolarRow& hi = *above;
  const PolarRow& lo = *(above - 1);
  const double w = (alpha_rad - lo.alpha_rad) / (hi.alpha_rad - lo.alpha_rad);
  return {lo.cl + w * (hi.cl - lo.cl), lo.cd + w * (hi.cd - lo.cd)};
}

}  // namespace

PolarFamily::PolarFamily(std::string name, std::vector<PolarCurve> curves, double lift_below,
                         double drag_within)
    : name_(std::move(name)),
      curves_(std::move(curves)),
      lift_below_(lift_below),
      drag_within_(drag_within) {
  WHIRL_CHECK(!curves_.empty());
}

PolarFamily PolarFamily::with_drag(double factor) const {
  PolarFamily scaled = *this;
  for (PolarCurve& curve : scaled.curves_) {
    for (PolarRow& row : curve.rows) row.cd *= factor;
  }
  return scaled;
}

SectionCoefficients PolarFamily::at(double alpha_rad, double reynolds) const {
  const double alpha = std::remainder(alpha_rad, 2.0 * kPi);
  const double re = std::clamp(reynolds, 1e3, 1e8);
  const auto above =
      std::upper_bound(curves_.begin(), curves_.end(), re,
                       [](double x, const PolarCurve& curve) { return x < curve.reynolds; });
  if (above == curves_.begin() || above == curves_.end()) {
    const PolarCurve& edge = above == curves_.begin() ? curves_.front() : curves_.back();
    SectionCoefficients c = on_curve(edge, alpha);
    const double ratio = re / edge.reynolds;
    if (above == curves_.begin()) {
      c.cl *= std::pow(ratio, lift_below_);
    } else {
      // Only the friction share falls on; separated drag does not ask for the Reynolds number.
      c.cd += std::min(c.cd, 0.05) * (std::pow(ratio, -0.2) - 1.0);
    }
    return c;
  }
  const PolarCurve& hi = *above;
  const PolarCurve& lo = *(above - 1);
  const double w = std::log(re / lo.reynolds) / std::log(hi.reynolds / lo.reynolds);
  const SectionCoefficients a = on_curve(lo, alpha);
  const SectionCoefficients b = on_curve(hi, alpha);
  return {a.cl + w * (b.cl - a.cl), a.cd + w * (b.cd - a.cd)};
}

PolarFamily::Attached PolarFamily::attached(double reynolds) const {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (double deg = -2.0; deg <= 4.01; deg += 0.5) {
    const double x = deg * kDeg;
    const double y = at(x, reynolds).cl;
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  return {-(sy - slope * sx) / n / slope, slope};
}

}  // namespace whirl::plant
