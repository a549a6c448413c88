#include "firmware/esc/core/thrust_estimator.hpp"

#include "firmware/esc/core/power_balance.hpp"

namespace fw::esc {
namespace {

constexpr float kElectrical_s = 0.003f;                          // of bus current and duty
constexpr Innovation kSpeedGains{.kp = 300.0f, .ki = 22500.0f};  // two poles at 150 rad/s
constexpr float kSmoothing_s = 0.05f;                            // of CP, at constant speed
constexpr float kCalming_s = 0.025f;                             // after a step
constexpr float kMinSpeed_radps = 150.0f;  // below, w^3 makes noise of everything

constexpr float kUsual_change = 0.05f;
// Air from above of up to 0.8 m/s takes 0.2 % of power, which no shunt shows, and 3.4 % of thrust.
constexpr float kUnseen_loss = 0.034f;
constexpr float kOne_sided = 1.1f;  // a shared_power beyond says that the air comes from above

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
  current_A_ = gapless_s_ = unrest_ = 0.0f;
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
  carry_to(w);
  const float shaft_Nm =
      aerodynamic_power_W(calibration_.losses, bus_V * duty_.value(), current_A_, w) / w;
  speed_.update(shaft_Nm, w);
  const float acceleration_Nm = calibration_.motor.inertia_kgm2 * speed_.acceleration_radps2();
  const float torque_Nm = shaft_Nm - acceleration_Nm;
  power_W_ = torque_Nm * w;
  const float ratio = torque_Nm / (w * w * calibration_.free_air.CP(w));
  // While the rotor accelerates, and until the filters have calmed down after it, the inertial term
  // dominates and its error with it: trust it less.
  const float share = acceleration_Nm / torque_Nm;
  const float unrest = share * share < 1.0f ? share * share : 1.0f;
  unrest_ -= period_s_ / kCalming_s * unrest_;
  if (unrest > unrest_) unrest_ = unrest;
  const float trust = 1.0f / (1.0f + 25.0f * unrest_);
  const float blend = period_s_ / (kSmoothing_s + period_s_);
  power_ratio_ += calibration_.power.holds(w) ? blend * trust * (ratio - power_ratio_)
                                              : blend * (1.0f - power_ratio_);
  CP_ = power_ratio_ * calibration_.free_air.CP(w);

  const bool gaps = has_gaps(calibration_.motor, bus_V_, duty_.value(), current_A_);
  gapless_s_ = gaps ? 0.0f : gapless_s_ + period_s_;
  last_ = conclude();
  const float expected = expected_ratio();
  const float found =
      observable() ? expected + confidence() * (last_.CT / still_.CT - expected) : expected;
  thrust_ratio_ += blend * (found - thrust_ratio_);
  CT_ = thrust_ratio_ * calibration_.free_air.CT(w);
  thrust_N_ = CT_ * w * w;
}

// The wind stays as it was: its inflow ratio falls as the rotor gains speed, and with it what it takes.
void ThrustEstimator::carry_to(float w) {
  if (observable()) {
    const PowerRange& range = calibration_.power;
    const float CP = last_.slope * last_.ls * (speed_radps_ / w - 1.0f);  // more than before
    const float taken = (1.0f - power_ratio_) * range.effect_at(speed_radps_);
    thrust_ratio_ *= 1.0f + confidence() * last_.leverage * CP / ((1.0f - taken) * still_.CP);
    power_ratio_ = 1.0f - (taken - CP / still_.CP) / range.effect_at(w);
  }
  speed_radps_ = w;
}

ThrustEstimate ThrustEstimator::conclude() {
  ThrustEstimate nothing;
  if (!calibration_.identified || !still_.real) return nothing;
  nothing.status = Estimate::not_observable;
  const float most = calibration_.shared_power < 1.0f ? calibration_.shared_power : 1.0f;
  const float sure = observable() ? 1.0f : 2.0f;  // it does not waver where it just begins to tell
  if (power_ratio_ >= most - sure * power_error()) return nothing;
  if (gapless_s_ < kSmoothing_s) return nothing;  // the ratio still holds what gaps made of it
  if (!calibration_.power.holds(speed_radps_)) return nothing;
  const float taken = (1.0f - power_ratio_) * calibration_.power.effect_at(speed_radps_);
  return solver_.solve((1.0f - taken) * still_.CP);
}

// Of thrust, before power is asked.
float ThrustEstimator::expected_ratio() const {
  const bool one_sided = calibration_.identified && calibration_.shared_power > kOne_sided;
  return one_sided ? 1.0f - 0.5f * kUnseen_loss : 1.0f;
}

// One sigma, as a share. Pre: it turns.
float ThrustEstimator::power_error() const {
  const float w = speed_radps_;
  return offset_A_ * watts_per_ampere() / (calibration_.free_air.CP(w) * w * w * w);
}

float ThrustEstimator::watts_per_ampere() const {
  const float duty = duty_.value();
  return power_per_bus_ampere_W(calibration_.losses, bus_V_ * duty, current_A_, speed_radps_, duty);
}

// Between what is expected and what power says, as their variances weigh: power errs with the shunt,
// which the leverage makes an error of thrust; inflow moves thrust by kUsual_change.
float ThrustEstimator::confidence() const {
  if (!observable()) return 0.0f;
  const float noise = last_.leverage * power_error() / kUsual_change;
  return 1.0f / (1.0f + noise * noise);
}

float ThrustEstimator::thrust_per_ampere() const {
  if (!observable() || !(power_W_ > 0.0f)) return 0.0f;
  return thrust_N_ * confidence() * last_.leverage * watts_per_ampere() / power_W_;
}

}  // namespace fw::esc
