#include "firmware/esc/core/thrust_model.hpp"

#include <cmath>

#include "firmware/esc/core/square_root.hpp"

namespace fw::esc {

RotorPoint at_inflow(const ThrustModel& m, float ls) {
  RotorPoint point;
  // c4 li^2 + li (c4 ls + c1) + c1 (ls - c2) = 0, the root with li > 0
  const float b = m.c4 * ls + m.c1;
  const float discriminant = b * b - 4.0f * m.c4 * m.c1 * (ls - m.c2);
  if (!(discriminant >= 0.0f)) return point;
  point.li = (square_root(discriminant) - b) / (2.0f * m.c4);
  point.CT = m.c1 * (m.c2 - point.li - ls);
  point.kappa = m.d0 + m.d1 * point.CT;
  point.CP = m.c3 + point.CT * (point.kappa * point.li + ls) * m.c0;
  point.real = point.li + ls > 0.0f && point.CT > 0.0f;
  return point;
}

ThrustSolver::ThrustSolver(const ThrustModel& model, const Bounds& bounds)
    : model_(model), bounds_(bounds) {
  bool any = false;
  for (std::uint8_t i = 0; i <= kCells; ++i) {
    const RotorPoint point = at_inflow(model, node_ls(i));
    if (!point.real) {
      if (any) break;
      continue;
    }
    CP_[i] = point.CP;
    CT_[i] = point.CT;
    if (!any) first_ = turn_ = i;
    if (CP_[i] > CP_[turn_]) turn_ = i;
    any = true;
    last_ = i;
  }
  std::uint8_t i = turn_;
  while (i < last_ && CP_[i + 1] < CP_[i]) ++i;
  last_ = i;
  for (i = turn_; i < last_; ++i) {
    slope_[i] = (CP_[i + 1] - CP_[i]) / (node_ls(i + 1) - node_ls(i));
    leverage_[i] = (CT_[i + 1] / CT_[i] - 1.0f) / (CP_[i + 1] / CP_[i] - 1.0f);
  }
}

ThrustEstimate ThrustSolver::solve(float CP_measured) {
  ThrustEstimate result;
  if (!(CP_measured > 0.0f)) return result;
  if (CP_measured >= CP_[turn_] || shared_by_two(CP_measured)) {
    result.status = Estimate::not_observable;
    return result;
  }
  if (CP_measured <= CP_[last_]) return result;  // more inflow than the model was made for
  int cell = turn_;
  while (CP_[cell + 1] >= CP_measured) ++cell;
  return search(cell, CP_measured);
}

// Secant between two nodes: power is too large at the lower one and too small at the upper one.
ThrustEstimate ThrustSolver::search(int cell, float CP_measured) {
  ThrustEstimate result;
  float low = node_ls(cell), high = node_ls(cell + 1);
  float f_low = CP_measured - CP_[cell], f_high = CP_measured - CP_[cell + 1];
  result.slope = slope_[cell];
  result.leverage = leverage_[cell];
  if (std::fabs(result.leverage) > bounds_.most_leverage) {
    result.status = Estimate::not_observable;
    return result;
  }
  const auto secant = [&] { return low - f_low * (high - low) / (f_high - f_low); };
  // From the last solution along the slope: mostly there at once.
  float x = ls_ + (CP_measured - CP_solved_) / result.slope;
  if (!(x > low && x < high)) x = secant();
  for (int k = 1; k <= kMaxIterations; ++k) {
    const RotorPoint point = at_inflow(model_, x);
    const float f = CP_measured - point.CP;
    result.iterations = static_cast<std::uint8_t>(k);
    if (std::fabs(f) <= bounds_.tolerance * CP_measured) {
      result.status = Estimate::converged;
      result.CT = point.CT;
      result.ls = ls_ = x;
      CP_solved_ = point.CP;
      return result;
    }
    const bool lower = f < 0.0f;  // more inflow is needed than x
    (lower ? low : high) = x;
    (lower ? f_low : f_high) = f;
    x = secant();
  }
  result.status = Estimate::no_convergence;
  return result;
}

}  // namespace fw::esc
