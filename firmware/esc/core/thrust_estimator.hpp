// Thrust of the turning rotor from what the ESC measures: aerodynamic power from current and speed,
// inflow from power, thrust from inflow.
//
//   Law     Pam (power_balance.hpp); CP = Pam / w^3, smoothed, over its value in still air at this
//           speed; inflow and CT by ThrustSolver; T = CT w^2
//   Scale   the model gives the shape over inflow, the static map thrust and power in still air: so
//           both follow the Reynolds number, and in still air both controllers agree
//   Where power decides nothing about inflow, observable() says so and CT of free air is used, or, if
//           air is known to come from above only, the CT in the middle of what cannot be told from
//           free air; where it decides little, the estimate lies between the two, as their errors weigh
//   Source  [Bangura 2017, eq. 5.4 and Algorithm 1]
#pragma once
#include "firmware/esc/core/calibration.hpp"
#include "firmware/esc/core/filters.hpp"

namespace fw::esc {

class ThrustEstimator {
 public:
  ThrustEstimator(const Calibration& calibration, float period_s);

  // What was measured over the last period, and the duty (above 0) that was applied in it.
  // offset_A: how wrong the zero of bus_A may be, one sigma.
  void update(float bus_V, float duty, float bus_A, float speed_radps, float offset_A);
  void restart(float speed_radps);

  float power_W() const { return power_W_; }  // aerodynamic, at this moment
  float CP() const { return CP_; }            // smoothed
  float CT() const { return CT_; }
  float thrust_N() const { return thrust_N_; }
  // Over still air at the same speed, smoothed; 1 where nothing is known.
  float power_ratio() const { return power_ratio_; }
  float thrust_ratio() const { return thrust_ratio_; }
  float current_A() const { return current_A_; }  // of the bus over duty, smoothed
  float acceleration_radps2() const { return speed_.acceleration_radps2(); }
  bool observable() const { return last_.status == Estimate::converged; }
  const ThrustEstimate& solution() const { return last_; }
  // How far one ampere of the bus too much would shift the estimated thrust.
  float thrust_per_ampere() const;

 private:
  void carry_to(float speed_radps);
  ThrustEstimate conclude();
  float confidence() const;
  float effect_at(float speed_radps) const;  // PowerRange::speed_effect

  Calibration calibration_;
  float period_s_;
  float blend_, calming_, per_middle_;
  float expected_ratio_;  // of thrust, where power tells nothing
  LowPass bus_A_, duty_;
  SpeedFilter speed_;
  ThrustSolver solver_;
  RotorPoint still_;  // the model's own still air
  float per_still_CT_, per_still_CP_;
  ThrustEstimate last_{};
  float current_A_ = 0.0f;
  float speed_radps_ = 0.0f;
  float watts_per_ampere_ = 0.0f;  // of the bus
  float power_error_ = 0.0f;       // one sigma, as a share
  float confidence_ = 0.0f;
  float power_W_ = 0.0f;
  float CP_ = 0.0f;
  float CT_ = 0.0f;
  float unrest_ = 0.0f;     // share of the rotor's own inertia in the torque, squared, lately
  float gapless_s_ = 0.0f;  // how long the winding current has had none
  float power_ratio_ = 1.0f;
  float thrust_ratio_ = 1.0f;
  float thrust_N_ = 0.0f;
};

}  // namespace fw::esc
