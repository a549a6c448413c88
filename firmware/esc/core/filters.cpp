#include "firmware/esc/core/filters.hpp"

#include <cmath>

#include "firmware/esc/core/speed_controller.hpp"

namespace fw::esc {

CurrentFilter::CurrentFilter(const MotorConstants& motor, float period_s, Innovation gains)
    : motor_(motor),
      period_s_(period_s),
      blend_(-std::expm1(-period_s * motor.resistance_ohm / motor.inductance_H)),
      gains_(gains) {}

float CurrentFilter::update(float voltage_V, float speed_radps, float current_A) {
  const float steady_A =
      (voltage_V + offset_V_ - motor_.Kt_NmpA * speed_radps) / drop_ohm(motor_, speed_radps);
  const float predicted_A = current_A_ + blend_ * (steady_A - current_A_);
  const float innovation_A = current_A - predicted_A;
  current_A_ = predicted_A + gains_.kp * period_s_ * innovation_A;
  offset_V_ += gains_.ki * period_s_ * period_s_ * motor_.resistance_ohm * innovation_A;
  return current_A_;
}

void CurrentFilter::restart(float current_A) {
  current_A_ = current_A;
  offset_V_ = 0.0f;
}

void SpeedFilter::update(float current_A, float speed_radps) {
  const float drive_Nm = motor_.Kt_NmpA * (current_A - motor_.no_load_current_A);
  const float drag_Nm = (free_air_.q2 * speed_radps_ + free_air_.q1) * speed_radps_;
  const float innovation = speed_radps - speed_radps_;
  offset_radps2_ += gains_.ki * period_s_ * innovation;
  acceleration_radps2_ = (drive_Nm - drag_Nm) / motor_.inertia_kgm2 + offset_radps2_;
  speed_radps_ += period_s_ * (acceleration_radps2_ + gains_.kp * innovation);
}

void SpeedFilter::restart(float speed_radps) {
  speed_radps_ = speed_radps;
  acceleration_radps2_ = 0.0f;
  offset_radps2_ = 0.0f;
}

}  // namespace fw::esc
