#include "firmware/esc/core/thrust_estimator.hpp"

#include "firmware/esc/core/power_balance.hpp"

namespace fw::esc {
namespace {

constexpr Innovation kCurrentGains{.kp = 60.0f, .ki = 4000.0f};
constexpr Innovation kSpeedGains{.kp = 120.0f, .ki = 3600.0f};  // two poles at 60 rad/s
constexpr float kSmoothing_s = 0.05f;                           // of CP, at constant speed
constexpr float kMinSpeed_radps = 150.0f;  // below, w^3 makes noise of everything

}  // namespace

ThrustEstimator::ThrustEstimator(const Calibration& calibration, float period_s)
    : calibration_(calibration),
      period_s_(period_s),
      current_(calibration.motor, period_s, kCurrentGains),
      speed_(calibration.motor, calibration.free_air, period_s, kSpeedGains),
      solver_(calibration.rotor),
      still_(at_inflow(calibration.rotor, 0.0f)) {}

void ThrustEstimator::restart(float speed_radps) {
  current_.restart(calibration_.motor.no_load_current_A);
  speed_.restart(speed_radps);
  solver_.restart();
  last_ = {};
  power_W_ = thrust_N_ = CP_ = CT_ = 0.0f;
  power_ratio_ = thrust_ratio_ = 1.0f;
}

void ThrustEstimator::update(float voltage_V, float speed_radps, float current_A) {
  current_.update(voltage_V, speed_radps, current_A);
  speed_.update(current_.current_A(), speed_radps);
  const float w = speed_radps;
  voltage_V_ = voltage_V;
  if (!(w > kMinSpeed_radps)) {
    last_ = {};
    power_W_ = thrust_N_ = CP_ = CT_ = 0.0f;
    power_ratio_ = thrust_ratio_ = 1.0f;
    return;
  }
  const float acceleration_Nm = calibration_.motor.inertia_kgm2 * speed_.acceleration_radps2();
  const float torque_Nm =
      aerodynamic_power_W(calibration_.losses, voltage_V, current_.current_A(), w) / w -
      acceleration_Nm;
  power_W_ = torque_Nm * w;
  const float ratio = torque_Nm / (w * w * free_air_CP(w));
  // While the rotor accelerates, the inertial term dominates and its error with it: trust it less.
  const float share = acceleration_Nm / torque_Nm;
  const float trust = 1.0f / (1.0f + 25.0f * share * share);
  const float blend = period_s_ / (kSmoothing_s + period_s_);
  power_ratio_ += blend * trust * (ratio - power_ratio_);
  CP_ = power_ratio_ * free_air_CP(w);

  last_ = calibration_.identified && still_.real ? solver_.solve(power_ratio_ * still_.CP)
                                                 : ThrustEstimate{};
  const float found = last_.status == Estimate::converged ? last_.CT / still_.CT : 1.0f;
  thrust_ratio_ += blend * (found - thrust_ratio_);
  CT_ = thrust_ratio_ * free_air_CT(w);
  thrust_N_ = CT_ * w * w;
}

float ThrustEstimator::thrust_per_ampere(float duty) const {
  if (!observable() || !(power_W_ > 0.0f) || !(duty > 0.0f)) return 0.0f;
  const float watts =
      power_per_bus_ampere_W(calibration_.losses, voltage_V_, current_.current_A(), duty);
  return thrust_N_ * last_.leverage * watts / power_W_;
}

}  // namespace fw::esc
