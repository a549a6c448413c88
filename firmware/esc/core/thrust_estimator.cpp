#include "firmware/esc/core/thrust_estimator.hpp"

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
      solver_(calibration.rotor) {}

float ThrustEstimator::free_air_CT(float w) const {
  return calibration_.free_air.a2 + calibration_.free_air.a1 / w;
}

void ThrustEstimator::restart(float speed_radps) {
  current_.restart(calibration_.motor.no_load_current_A);
  speed_.restart(speed_radps);
  solver_.restart();
  CP_ = CT_ = 0.0f;
}

void ThrustEstimator::update(float voltage_V, float speed_radps, float current_A) {
  const MotorConstants& motor = calibration_.motor;
  current_.update(voltage_V, speed_radps, current_A);
  speed_.update(current_.current_A(), speed_radps);
  const float w = speed_radps;
  if (!(w > kMinSpeed_radps)) {
    last_ = {};
    thrust_N_ = 0.0f;
    CP_ = CT_ = 0.0f;
    return;
  }
  const float acceleration_Nm = motor.inertia_kgm2 * speed_.acceleration_radps2();
  const float torque_Nm =
      motor.Kt_NmpA * (current_.current_A() - motor.no_load_current_A) - acceleration_Nm;
  power_W_ = torque_Nm * w;
  const float CP = power_W_ / (w * w * w);
  // While the rotor accelerates, the inertial term dominates and its error with it: trust it less.
  const float share = acceleration_Nm / torque_Nm;
  const float trust = 1.0f / (1.0f + 25.0f * share * share);
  const float blend = period_s_ / (kSmoothing_s + period_s_) * trust;
  CP_ = CP_ == 0.0f ? CP : CP_ + blend * (CP - CP_);

  last_ = calibration_.identified ? solver_.solve(CP_) : ThrustEstimate{};
  const float found = last_.status == Estimate::converged ? last_.CT : free_air_CT(w);
  CT_ = CT_ == 0.0f ? found : CT_ + period_s_ / (kSmoothing_s + period_s_) * (found - CT_);
  thrust_N_ = CT_ * w * w;
}

}  // namespace fw::esc
