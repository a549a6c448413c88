#include "firmware/esc/core/thrust_estimator.hpp"

#include "firmware/esc/core/power_balance.hpp"

namespace fw::esc {
namespace {

constexpr float kElectrical_s = 0.003f;                         // of bus current and duty
constexpr Innovation kSpeedGains{.kp = 120.0f, .ki = 3600.0f};  // two poles at 60 rad/s
constexpr float kSmoothing_s = 0.05f;                           // of CP, at constant speed
constexpr float kMinSpeed_radps = 150.0f;  // below, w^3 makes noise of everything

constexpr float kPower_error = 0.004f;  // the shunt wanders by 10 mA
constexpr float kUsual_change = 0.05f;

}  // namespace

ThrustEstimator::ThrustEstimator(const Calibration& calibration, float period_s)
    : calibration_(calibration),
      period_s_(period_s),
      bus_A_(kElectrical_s, period_s),
      duty_(kElectrical_s, period_s),
      speed_(calibration.motor, calibration.free_air, period_s, kSpeedGains),
      solver_(calibration.rotor),
      still_(at_inflow(calibration.rotor, 0.0f)) {}

void ThrustEstimator::restart(float speed_radps) {
  bus_A_.restart(0.0f);
  duty_.restart(0.0f);
  current_A_ = gapless_s_ = 0.0f;
  speed_.restart(speed_radps);
  solver_.restart();
  last_ = {};
  power_W_ = thrust_N_ = CP_ = CT_ = 0.0f;
  power_ratio_ = thrust_ratio_ = 1.0f;
}

void ThrustEstimator::update(float bus_V, float duty, float bus_A, float speed_radps) {
  const float w = speed_radps;
  if (!(w > kMinSpeed_radps)) {
    restart(w);
    return;
  }
  if (duty_.value() == 0.0f) {
    duty_.restart(duty);
    bus_A_.restart(bus_A);
    speed_.restart(w);
  }
  duty_.update(duty);
  current_A_ = bus_A_.update(bus_A) / duty_.value();
  bus_V_ = bus_V;
  const float shaft_Nm =
      aerodynamic_power_W(calibration_.losses, bus_V * duty_.value(), current_A_, w) / w;
  speed_.update(shaft_Nm, w);
  const float acceleration_Nm = calibration_.motor.inertia_kgm2 * speed_.acceleration_radps2();
  const float torque_Nm = shaft_Nm - acceleration_Nm;
  power_W_ = torque_Nm * w;
  const float ratio = torque_Nm / (w * w * calibration_.free_air.CP(w));
  // While the rotor accelerates, the inertial term dominates and its error with it: trust it less.
  const float share = acceleration_Nm / torque_Nm;
  const float trust = 1.0f / (1.0f + 25.0f * share * share);
  const float blend = period_s_ / (kSmoothing_s + period_s_);
  power_ratio_ += blend * trust * (ratio - power_ratio_);
  CP_ = power_ratio_ * calibration_.free_air.CP(w);

  const bool gaps = has_gaps(calibration_.motor, bus_V_, duty_.value(), current_A_);
  gapless_s_ = gaps ? 0.0f : gapless_s_ + period_s_;
  last_ = conclude();
  const float found = observable() ? 1.0f + confidence() * (last_.CT / still_.CT - 1.0f) : 1.0f;
  thrust_ratio_ += blend * (found - thrust_ratio_);
  CT_ = thrust_ratio_ * calibration_.free_air.CT(w);
  thrust_N_ = CT_ * w * w;
}

ThrustEstimate ThrustEstimator::conclude() {
  ThrustEstimate nothing;
  if (!calibration_.identified || !still_.real) return nothing;
  nothing.status = Estimate::not_observable;
  if (power_ratio_ >= calibration_.shared_power - 2.0f * kPower_error) return nothing;
  if (gapless_s_ < kSmoothing_s) return nothing;  // the ratio still holds what gaps made of it
  return solver_.solve(power_ratio_ * still_.CP);
}

// Between still air and what power says, as their variances weigh: power errs by kPower_error, which
// the leverage makes an error of thrust; inflow moves thrust by kUsual_change.
float ThrustEstimator::confidence() const {
  if (!observable()) return 0.0f;
  const float noise = last_.leverage * kPower_error / kUsual_change;
  return 1.0f / (1.0f + noise * noise);
}

float ThrustEstimator::thrust_per_ampere() const {
  if (!observable() || !(power_W_ > 0.0f)) return 0.0f;
  const float duty = duty_.value();
  const float watts = power_per_bus_ampere_W(calibration_.losses, bus_V_ * duty, current_A_, duty);
  return thrust_N_ * confidence() * last_.leverage * watts / power_W_;
}

}  // namespace fw::esc
