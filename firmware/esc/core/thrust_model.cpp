#include "firmware/esc/core/thrust_model.hpp"

#include <cmath>

namespace fw::esc {

RotorPoint at_inflow(const ThrustModel& m, float ls) {
  RotorPoint point;
  // c4 li^2 + li (c4 ls + c1) + c1 (ls - c2) = 0, the root with li > 0
  const float b = m.c4 * ls + m.c1;
  const float discriminant = b * b - 4.0f * m.c4 * m.c1 * (ls - m.c2);
  if (!(discriminant >= 0.0f)) return point;
  point.li = (-b + std::sqrt(discriminant)) / (2.0f * m.c4);
  point.CT = m.c1 * (m.c2 - point.li - ls);
  point.kappa = m.d0 + m.d1 * point.CT;
  point.CP = m.c3 + point.CT * (point.kappa * point.li + ls) * m.c0;
  point.real = point.li + ls > 0.0f && point.CT > 0.0f;
  return point;
}

ThrustSolver::ThrustSolver(const ThrustModel& model, const Bounds& bounds)
    : model_(model), bounds_(bounds) {
  constexpr int kScan = 64;
  ls_first_ = ls_turn_ = bounds.ls_max;
  CP_first_ = CP_turn_ = CP_last_ = 0.0f;
  bool any = false;
  for (int i = 0; i <= kScan; ++i) {
    const float ls =
        bounds.ls_min + (bounds.ls_max - bounds.ls_min) * static_cast<float>(i) / kScan;
    const RotorPoint point = at_inflow(model, ls);
    if (!point.real) continue;
    if (!any) {
      ls_first_ = ls;
      CP_first_ = point.CP;
    }
    if (!any || point.CP > CP_turn_) {
      ls_turn_ = ls;
      CP_turn_ = point.CP;
    }
    CP_last_ = point.CP;
    bounds_.ls_max = ls;
    any = true;
  }
}

ThrustEstimate ThrustSolver::solve(float CP_measured) {
  ThrustEstimate result;
  if (!(CP_measured > 0.0f)) return result;
  if (CP_measured >= CP_turn_ || shared_by_two(CP_measured)) {
    result.status = Estimate::not_observable;
    return result;
  }
  if (CP_measured <= CP_last_) return result;  // more inflow than the model was made for
  // Secant between the bounds in which CP falls from CP_turn_ to CP_last_.
  float low = ls_turn_, high = bounds_.ls_max;
  const auto inside = [&](float x) { return x > low && x < high ? x : 0.5f * (low + high); };
  float x0 = inside(ls_ - bounds_.start_distance);
  float x1 = inside(ls_);
  if (x1 == x0) x1 = inside(x0 + bounds_.start_distance);
  float f0 = 0.0f;
  for (int k = 1; k <= kMaxIterations; ++k) {
    const float x = k == 1 ? x0 : x1;
    const RotorPoint point = at_inflow(model_, x);
    const float f = CP_measured - point.CP;
    (f < 0.0f ? low : high) = x;  // too much power: more inflow needed
    if (k == 1) {
      f0 = f;
      continue;
    }
    result.iterations = static_cast<std::uint8_t>(k);
    result.slope = -(f - f0) / (x1 - x0);
    if (std::fabs(f) <= bounds_.tolerance * CP_measured) {
      const float flat = bounds_.flat * CP_measured / (bounds_.ls_max - bounds_.ls_min);
      result.status =
          std::fabs(result.slope) < flat ? Estimate::not_observable : Estimate::converged;
      result.CT = point.CT;
      result.ls = ls_ = x;
      return result;
    }
    const float next = result.slope != 0.0f ? x1 + f / result.slope : low;  // low: bisect
    x0 = x1;
    f0 = f;
    x1 = inside(next);
  }
  result.status = Estimate::no_convergence;
  return result;
}

}  // namespace fw::esc
