#include "firmware/esc/core/thrust_estimator.hpp"

#include "firmware/esc/core/power_balance.hpp"

namespace fw::esc {
namespace {

constexpr float kElectrical_s = 0.003f;                          // of bus current and duty
constexpr Innovation kSpeedGains{.kp = 300.0f, .ki = 22500.0f};  // two poles at 150 rad/s
constexpr float kSmoothing_s = 0.05f;                            // of CP, at constant speed
constexpr float kCalming_s = 0.025f;                             // after a step
constexpr float kCalm = 1e-3f;  // of unrest: the inertial torque is 3 % of the air's
// How long a told inflow outlasts gaps: a rotor that coasts has them.
constexpr float kHeld_s = 0.25f;
// No wind takes more power than still air. What seems to is an error of the balance, a bearing colder than at the
// calibration: taken off the torque, for as long as a motor takes to warm up by a good part.
constexpr float kExcess_s = 0.3f, kExcess_lasts_s = 20.0f;
constexpr float kExcess_share = 0.05f;     // of still air's torque, at most: more is no bearing
constexpr float kMinSpeed_radps = 150.0f;  // below, w^3 makes noise of everything

constexpr float kUsual_change =
    0.05f;  // of thrust by inflow, as a share: the prior of confidence()
constexpr float kUnseen_loss = 0.034f;  // of thrust at 0.8 m/s from above, which no shunt shows
constexpr float kOne_sided = 1.1f;      // a shared_power beyond says that the air comes from above

// Of thrust over still air, before power is asked.
float expected(const Calibration& calibration) {
  const bool one_sided = calibration.identified && calibration.shared_power > kOne_sided;
  return one_sided ? 1.0f - 0.5f * kUnseen_loss : 1.0f;
}

}  // namespace

ThrustEstimator::ThrustEstimator(const Calibration& calibration, float period_s)
    : calibration_(calibration),
      period_s_(period_s),
      blend_(period_s / (kSmoothing_s + period_s)),
      calming_(period_s / kCalming_s),
      still_effect_(1.0f - calibration.power.speed_effect),
      effect_slope_s_(2.0f * calibration.power.speed_effect /
                      (calibration.power.from_radps + calibration.power.to_radps)),
      expected_ratio_(expected(calibration)),
      bus_A_(kElectrical_s, period_s),
      duty_(kElectrical_s, period_s),
      speed_(calibration.motor, calibration.free_air, period_s, kSpeedGains),
      solver_(calibration.rotor),
      still_(at_inflow(calibration.rotor, 0.0f)),
      per_still_CT_(still_.real ? 1.0f / still_.CT : 0.0f),
      per_still_CP_(still_.real ? 1.0f / still_.CP : 0.0f) {}

void ThrustEstimator::restart(float speed_radps) {
  bus_A_.restart(0.0f);
  duty_.restart(0.0f);
  current_A_ = gapless_s_ = blind_s_ = unrest_ = 0.0f;
  speed_.restart(speed_radps);
  solver_.restart();
  last_ = {};
  power_W_ = thrust_N_ = CP_ = CT_ = excess_Nm_ = 0.0f;
  power_ratio_ = thrust_ratio_ = 1.0f;
}

void ThrustEstimator::update(float bus_V, float duty, float bus_A, float speed_radps,
                             float offset_A) {
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
  const float voltage_V = bus_V * duty_.value(), per_duty = 1.0f / duty_.value();
  current_A_ = bus_A_.update(bus_A) * per_duty;
  carry_to(w);
  const LossMap& losses = calibration_.losses;
  const float freed_V = freed_by_bus_V(losses, calibration_.motor.freewheel_V, voltage_V, bus_V);
  const float shaft_W =
      aerodynamic_power_W(losses, voltage_V, current_A_, w) + freed_V * current_A_;
  const float shaft_Nm = shaft_W / w;
  speed_.update(shaft_Nm, w);
  const float acceleration_Nm = calibration_.motor.inertia_kgm2 * speed_.acceleration_radps2();
  const float torque_Nm = shaft_Nm - acceleration_Nm - excess_Nm_;
  power_W_ = torque_Nm * w;
  const bool gaps = has_gaps(calibration_.motor, bus_V, duty_.value(), current_A_);
  gapless_s_ = gaps ? 0.0f : gapless_s_ + period_s_;
  blind_s_ = gapless_s_ < kSmoothing_s ? blind_s_ + period_s_ : 0.0f;
  const float still_CP = calibration_.free_air.CP(w), still_Nm = still_CP * w * w;
  // While the rotor accelerates, and a little after, the inertial term's error dominates.
  const float share = acceleration_Nm / torque_Nm;
  const float unrest = share * share < 1.0f ? share * share : 1.0f;
  unrest_ -= calming_ * unrest_;
  if (unrest > unrest_) unrest_ = unrest;
  // What was told before the gaps is carried on, and nothing mixed in.
  if (!(gaps && observable())) {
    const float per_still_W = 1.0f / (still_Nm * w);
    watts_per_ampere_ =
        per_duty * power_per_ampere_W(calibration_.losses, voltage_V, current_A_, w);
    power_error_ = offset_A * watts_per_ampere_ * per_still_W;
    const float trust = 1.0f / (1.0f + 25.0f * unrest_);
    power_ratio_ += calibration_.power.holds(w)
                        ? blend_ * trust * (power_W_ * per_still_W - power_ratio_)
                        : blend_ * (1.0f - power_ratio_);
  }
  if (calibration_.identified && !gaps && calibration_.power.holds(w)) note_excess(still_Nm);
  CP_ = power_ratio_ * still_CP;
  last_ = conclude();
  swing_ = -last_.slope * last_.ls * per_still_CP_;
  confidence_ = confidence();
  const float found = expected_ratio_ + confidence_ * (last_.CT * per_still_CT_ - expected_ratio_);
  thrust_ratio_ += blend_ * (found - thrust_ratio_);
  CT_ = thrust_ratio_ * calibration_.free_air.CT(w);
  thrust_N_ = CT_ * w * w;
}

void ThrustEstimator::note_excess(float still_Nm) {
  const float more_Nm = (power_ratio_ - 1.0f) * still_Nm;
  if (more_Nm < 0.0f) {
    excess_Nm_ -= period_s_ / kExcess_lasts_s * excess_Nm_;
  } else if (unrest_ < kCalm && excess_Nm_ < kExcess_share * still_Nm) {
    excess_Nm_ += period_s_ / kExcess_s * more_Nm;
  }
}

// After a speed step the wind (m/s) is unchanged, so inflow ratio = wind / (w R) shrinks. Rescale both
// ratios now instead of waiting for the filter.
void ThrustEstimator::carry_to(float w) {
  effect_ = still_effect_ + effect_slope_s_ * w;
  if (observable()) {
    const float less = swing_ * (1.0f - speed_radps_ / w);
    thrust_ratio_ *= 1.0f + confidence_ * last_.leverage * less / (1.0f - taken_);
    taken_ -= less;
    power_ratio_ = 1.0f - taken_ / effect_;
  }
  speed_radps_ = w;
}

ThrustEstimate ThrustEstimator::conclude() {
  ThrustEstimate nothing;
  if (!calibration_.identified || !still_.real) return nothing;
  nothing.status = Estimate::not_observable;
  taken_ = (1.0f - power_ratio_) * effect_;
  const float highest = calibration_.shared_power < 1.0f ? calibration_.shared_power : 1.0f;
  const float sigmas_needed = observable() ? 1.0f : 2.0f;  // hysteresis
  const float limit = highest - sigmas_needed * power_error_;
  if (power_ratio_ >= limit && !(observable() && outlasts(limit))) return nothing;
  // The smoothed ratio still holds what gaps made of it, unless an inflow was told before them.
  const bool told_before = observable() && blind_s_ < kHeld_s;
  if (gapless_s_ < kSmoothing_s && !told_before) return nothing;
  if (!calibration_.power.holds(speed_radps_)) return nothing;
  return solver_.solve((1.0f - taken_) * still_.CP);
}

// What was told has made the rotor faster, and of a faster one the same wind takes a smaller share: at still air's
// speed, slower by the thrust ratio's root (to its square), it would be told.
bool ThrustEstimator::outlasts(float limit) const {
  const float less = 1.0f - thrust_ratio_;
  const float taken = taken_ + swing_ * less * (0.5f + 0.375f * less);
  return taken > (1.0f - limit) * (effect_ - 0.5f * less * effect_slope_s_ * speed_radps_);
}

// Weight of what power says against what is expected, by inverse variances.
float ThrustEstimator::confidence() const {
  if (!observable()) return 0.0f;
  const float noise = last_.leverage * power_error_ * (1.0f / kUsual_change);
  return 1.0f / (1.0f + noise * noise);
}

bool ThrustEstimator::balanced() const {
  return calibration_.identified && calibration_.power.holds(speed_radps_) && unrest_ < kCalm &&
         gapless_s_ > kSmoothing_s;
}

float ThrustEstimator::balance_ratio() const {
  const float w = speed_radps_;
  return (power_W_ + excess_Nm_ * w) / (calibration_.free_air.CP(w) * w * w * w);
}

// What it has concluded from the power before, is of the map before.
void ThrustEstimator::take_still_power(float share) {
  calibration_.free_air.take_still_power(share);
  excess_Nm_ = 0.0f;
  last_ = {};
  confidence_ = 0.0f;
  power_ratio_ = 1.0f;
}

float ThrustEstimator::thrust_per_ampere() const {
  if (!observable() || !(power_W_ > 0.0f)) return 0.0f;
  return thrust_N_ * confidence_ * last_.leverage * watts_per_ampere_ / power_W_;
}

}  // namespace fw::esc
