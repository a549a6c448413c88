#include "harness/inflow_bound/rotor_map.hpp"

#include <algorithm>
#include <cmath>

#include "plant/rotor/rotor.hpp"

namespace whirl::inflow_bound {
namespace {

constexpr int kRatios = 49;

}  // namespace

RotorMap::RotorMap(const std::shared_ptr<const plant::Blade>& blade, double density_kgpm3,
                   double low_radps, double high_radps)
    : low_ratio_m_(kLow_mps / low_radps),
      step_m_((kHigh_mps - kLow_mps) / low_radps / (kRatios - 1)) {
  const plant::Rotor rotor(blade, +1);
  for (std::size_t row = 0; row < kRows; ++row) {
    const double share = static_cast<double>(row) / (kRows - 1);
    const double w = low_radps * std::pow(high_radps / low_radps, share);
    speeds_[row] = w;
    for (int i = 0; i < kRatios; ++i) {
      plant::RotorConditions c;
      c.omega_radps = w;
      c.v_AP_P_mps.z() = -std::clamp((low_ratio_m_ + i * step_m_) * w, kLow_mps, kHigh_mps);
      c.density_kgpm3 = density_kgpm3;
      const plant::RotorLoads loads = rotor.steady(c);
      rows_[row].CT.push_back(loads.thrust_N / (w * w));
      rows_[row].CQ.push_back(loads.shaft_torque_Nm / (w * w));
    }
  }
}

RotorMap::Loads RotorMap::of_row(int row, double ratio_m) const {
  const Row& r = rows_[static_cast<std::size_t>(row)];
  const double place = std::clamp((ratio_m - low_ratio_m_) / step_m_, 0.0, kRatios - 1.0);
  const int left = std::min(static_cast<int>(place), kRatios - 2);
  const auto i = static_cast<std::size_t>(left);
  return {std::lerp(r.CT[i], r.CT[i + 1], place - left),
          std::lerp(r.CQ[i], r.CQ[i + 1], place - left)};
}

// The parabola through three rows about the speed, over its logarithm.
RotorMap::Loads RotorMap::at(double speed_radps, double inflow_mps) const {
  const double w = std::clamp(speed_radps, speeds_.front(), speeds_.back());
  const double v = std::clamp(inflow_mps, kLow_mps, kHigh_mps);
  const double spacing = std::log(speeds_[1] / speeds_[0]);
  const double place = std::log(w / speeds_.front()) / spacing;
  const int middle = std::clamp(static_cast<int>(std::lround(place)), 1, kRows - 2);
  const double x = place - middle;
  const std::array<double, 3> weight = {0.5 * x * (x - 1.0), 1.0 - x * x, 0.5 * x * (x + 1.0)};
  Loads sum;
  for (int k = 0; k < 3; ++k) {
    const Loads row = of_row(middle - 1 + k, v / w);
    const double share = weight[static_cast<std::size_t>(k)];
    sum.thrust_N += share * row.thrust_N * w * w;
    sum.torque_Nm += share * row.torque_Nm * w * w;
  }
  return sum;
}

double RotorMap::speed_for(double thrust_N, double inflow_mps) const {
  double low = speeds_.front(), high = speeds_.back();
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (at(middle, inflow_mps).thrust_N < thrust_N ? low : high) = middle;
  }
  return high;
}

}  // namespace whirl::inflow_bound
