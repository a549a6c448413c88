// Thrust and torque of a propeller over speed and axial inflow, from a table of the plant's rotor: a thousand
// questions cost what a few hundred steady states do.
//
//   Frame    inflow_mps positive: air from above
//   Table    coefficients over inflow / speed at kRows speeds; straight between ratios, a parabola between speeds
//   Valid    speeds between low and high, inflow kLow_mps to kHigh_mps; beyond them the nearest that is
//   Error    0.1 % of thrust and torque against the rotor itself (tests/bound_test.cpp)
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "plant/rotor/blade.hpp"

namespace whirl::inflow_bound {

inline constexpr double kLow_mps = -4.0, kHigh_mps = 6.0;

class RotorMap {
 public:
  RotorMap(const std::shared_ptr<const plant::Blade>& blade, double density_kgpm3, double low_radps,
           double high_radps);

  struct Loads {
    double thrust_N = 0.0, torque_Nm = 0.0;
  };
  Loads at(double speed_radps, double inflow_mps) const;
  // The speed that lifts this thrust, to 1e-9 of itself; the table's highest where none does.
  double speed_for(double thrust_N, double inflow_mps) const;
  double high_radps() const { return speeds_.back(); }

 private:
  static constexpr int kRows = 4;
  struct Row {
    std::vector<double> CT, CQ;  // over speed squared
  };
  Loads of_row(int row, double ratio_m) const;
  double low_ratio_m_, step_m_;
  std::array<double, kRows> speeds_{};
  std::array<Row, kRows> rows_;
};

}  // namespace whirl::inflow_bound
