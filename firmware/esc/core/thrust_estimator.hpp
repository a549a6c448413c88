// Thrust of the turning rotor from what the ESC measures. Derivation, numbers: docs/thrust_estimator.md.
//
//   Law     aerodynamic power (power_balance.hpp) as a ratio to still air's at this speed, smoothed;
//           from it inflow and CT (ThrustSolver); T = CT w^2
//   Valid   where power determines inflow: observable(). Elsewhere still air's CT, or what is expected
//           of air that comes from above only; between the two as their errors weigh
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
  // The power balance holds: calibrated, at a speed for which it was, the rotor calm, no gaps in the current.
  bool balanced() const;
  // Power of this moment over that of still air's map, with all that has been taken for an error of the balance. Pre: balanced().
  float balance_ratio() const;
  // From now on that share of it is still air's power.
  void take_still_power(float share);
  // How far one ampere of the bus too much would shift the estimated thrust.
  float thrust_per_ampere() const;

 private:
  void carry_to(float speed_radps);
  void note_excess(float still_Nm);
  bool outlasts(float limit) const;
  ThrustEstimate conclude();
  float confidence() const;

  Calibration calibration_;
  float period_s_;
  float blend_, calming_;
  float still_effect_, effect_slope_s_;  // PowerRange::speed_effect, over speed
  float expected_ratio_;                 // of thrust, where power tells nothing
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
  float blind_s_ = 0.0f;    // how long power has told nothing for gaps, and for the smoothing after
  float power_ratio_ = 1.0f;
  float effect_ = 1.0f;  // PowerRange::speed_effect at this speed
  float taken_ = 0.0f;   // of still air's power, the share that the model's inflow takes
  float swing_ =
      0.0f;  // how much of it the told wind does not take of a faster rotor, per relative speed
  float excess_Nm_ = 0.0f;  // by which the balance has found more than any air takes
  float thrust_ratio_ = 1.0f;
  float thrust_N_ = 0.0f;
};

}  // namespace fw::esc
