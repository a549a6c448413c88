// Rotor speed by voltage: feedforward of the steady state, PI, and the bounds that keep the winding
// current within its limits at this very speed.
//
//   Law     va = vff(wd) - Kp (w - wd) - Ki int(w - wd); Ke w - i_brake R <= va <= Ke w + i_max R',
//           where R' counts the drop of commutation too
//   Source  [Bangura 2017, sec. 3.4 and 5.3.2]; the bound is its over-current guard
#pragma once
#include "firmware/esc/core/calibration.hpp"

namespace fw::esc {

struct SpeedGains {
  float coast_radps = 4.0f;  // too fast by more than this
  float kp_coast = 0.5f;     // V s, beside kp
  float kp = 0.10f;          // V s
  float ki = 0.4f;           // V
};

struct VoltageDemand {
  float voltage_V;
  bool saturated;
};

// What a bridge has to overcome per ampere: resistance and commutation.
inline float drop_ohm(const MotorConstants& motor, float w) {
  return motor.resistance_ohm + motor.overlap_ohm_s * w;
}

// Steady voltage at a speed in free air.
inline float steady_voltage_V(const MotorConstants& motor, const StaticMap& free_air, float w) {
  const float current_A = motor.no_load_current_A + free_air.CP(w) * w * w / motor.Kt_NmpA;
  return motor.Kt_NmpA * w + drop_ohm(motor, w) * current_A;
}

// With the highest current no propeller slows down: one that does is held by something, and gets
// less. share: of the highest current.
inline constexpr float kHeld_share = 0.4f;
// Of the highest current, on the mean: between commutations it is a fifth higher, PWM ripple beside.
inline constexpr float kMean_share = 0.93f;

// Of a motor's constant, from copy to copy: what makers state.
inline constexpr float kOpen_share = 0.05f;

// less_V: by which the back-EMF may be less than Kt w.
inline VoltageDemand within_current_limits(const MotorConstants& motor, float wanted_V, float w,
                                           float bus_V, float share = 1.0f, float less_V = 0.0f) {
  const float emf_V = motor.Kt_NmpA * w;
  // A voltage is duty x bus here, and the diodes take theirs while the PWM is off: (1 - duty) of it.
  float high_V = (emf_V - less_V + kMean_share * share * motor.max_current_A * drop_ohm(motor, w) +
                  motor.freewheel_V) *
                 bus_V / (bus_V + motor.freewheel_V);
  // Diodes carry nothing back: with them the motor may coast whatever its back-EMF.
  float low_V =
      motor.freewheel_V > 0.0f ? 0.0f : emf_V - motor.max_braking_A * motor.resistance_ohm;
  if (high_V > bus_V) high_V = bus_V;
  if (low_V < 0.0f) low_V = 0.0f;
  if (wanted_V > high_V) return {high_V, true};
  if (wanted_V < low_V) return {low_V, true};
  return {wanted_V, false};
}

// Rotor speed as control wants it, with little noise, and as bounds do, without lag: what lags lets the current exceed.
struct RotorSpeed {
  float recent_radps, latest_radps;
};

class SpeedController {
 public:
  SpeedController(const MotorConstants& motor, const StaticMap& free_air, const SpeedGains& gains,
                  float period_s, bool told)
      : motor_(motor),
        free_air_(free_air),
        gains_(gains),
        period_s_(period_s),
        learning_per_V_(period_s / (kLearning_s * 400.0f * motor.Kt_NmpA)),
        open_share_(told ? 0.0f : kOpen_share),
        less_(open_share_) {}

  VoltageDemand update(float wanted_radps, const RotorSpeed& speed, float bus_V,
                       float share = 1.0f) {
    const float error = wanted_radps - speed.recent_radps;
    float proportional_V = steady_voltage_V(motor_, free_air_, wanted_radps) + gains_.kp * error;
    // A rotor that is too fast can but coast: the sooner it does so to the end, the sooner it is there.
    if (error < -gains_.coast_radps)
      proportional_V += gains_.kp_coast * (error + gains_.coast_radps);
    const float less_V = less_ * motor_.Kt_NmpA * speed.latest_radps;
    const VoltageDemand demand = within_current_limits(motor_, proportional_V + integral_V_,
                                                       speed.latest_radps, bus_V, share, less_V);
    // Conditional integration: a bound that the error pushes against must not wind up.
    const float excess_V = proportional_V + integral_V_ - demand.voltage_V;
    if (excess_V * error <= 0.0f) integral_V_ += gains_.ki * error * period_s_;
    if (error * error < kSteady_radps * kSteady_radps) learn(less_V);
    return demand;
  }
  void restart() { integral_V_ = 0.0f; }
  void take_still_power(float share) { free_air_.take_still_power(share); }

 private:
  static constexpr float kSteady_radps = 4.0f;
  static constexpr float kLearning_s = 0.5f;  // at 400 rad/s: twice what the integral takes

  // Steady running that takes less voltage than believed tells of a smaller back-EMF. Without a division.
  void learn(float latest_less_V) {
    less_ += learning_per_V_ * (-integral_V_ - latest_less_V);
    less_ = less_ < 0.0f ? 0.0f : less_ > open_share_ ? open_share_ : less_;
  }

  MotorConstants motor_;
  StaticMap free_air_;
  SpeedGains gains_;
  float period_s_, learning_per_V_;
  float integral_V_ = 0.0f;
  float open_share_;  // nothing of a motor whose own constant has been told
  float less_;        // by which the back-EMF may be less, as a share; not forgotten at rest
};

}  // namespace fw::esc
