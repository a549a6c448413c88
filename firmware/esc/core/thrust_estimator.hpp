// Thrust of the turning rotor from what the ESC measures: aerodynamic power from current and speed,
// inflow from power, thrust from inflow.
//
//   Law     Pam = Kt (i - i0) w - Ir w w'; CP = Pam / w^3, smoothed; CT by ThrustSolver; T = CT w^2
//   Where power decides nothing about inflow, CT of free air is used and `observable` says so.
//   Source  [Bangura 2017, eq. 5.4 and Algorithm 1]
#pragma once
#include "firmware/esc/core/calibration.hpp"
#include "firmware/esc/core/filters.hpp"

namespace fw::esc {

class ThrustEstimator {
 public:
  ThrustEstimator(const Calibration& calibration, float period_s);

  // current_A: of the winding, measured; voltage_V: applied over the last period.
  void update(float voltage_V, float speed_radps, float current_A);
  void restart(float speed_radps);

  float power_W() const { return power_W_; }  // aerodynamic, at this moment
  float CP() const { return CP_; }            // smoothed
  float CT() const { return CT_; }            // smoothed; never 0 after the first update
  float thrust_N() const { return thrust_N_; }
  float current_A() const { return current_.current_A(); }
  float acceleration_radps2() const { return speed_.acceleration_radps2(); }
  bool observable() const { return last_.status == Estimate::converged; }
  const ThrustEstimate& solution() const { return last_; }

 private:
  float free_air_CT(float speed_radps) const;

  Calibration calibration_;
  float period_s_;
  CurrentFilter current_;
  SpeedFilter speed_;
  ThrustSolver solver_;
  ThrustEstimate last_{};
  float power_W_ = 0.0f;
  float CP_ = 0.0f;
  float CT_ = 0.0f;
  float thrust_N_ = 0.0f;
};

}  // namespace fw::esc
