#include "firmware/esc/core/filters.hpp"

namespace fw::esc {

void SpeedFilter::update(float torque_Nm, float speed_radps) {
  const float drag_Nm = free_air_.CP(speed_radps_) * speed_radps_ * speed_radps_;
  const float innovation = speed_radps - speed_radps_;
  offset_radps2_ += gains_.ki * period_s_ * innovation;
  acceleration_radps2_ = (torque_Nm - drag_Nm) * per_inertia_ + offset_radps2_;
  speed_radps_ += period_s_ * (acceleration_radps2_ + gains_.kp * innovation);
}

void SpeedFilter::restart(float speed_radps) {
  speed_radps_ = speed_radps;
  acceleration_radps2_ = 0.0f;
  offset_radps2_ = 0.0f;
}

}  // namespace fw::esc
