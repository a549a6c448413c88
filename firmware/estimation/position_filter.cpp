#include "firmware/estimation/position_filter.hpp"

#include "firmware/config/vehicle.hpp"

namespace fw {

void PositionFilter::start(const Vector3& p_WB_W_m) {
  p_W_m_ = p_WB_W_m;
  v_W_mps_.setZero();
  bias_W_mps2_.setZero();
  innovation_W_m_.setZero();
}

void PositionFilter::predict(const Quaternion& q_WB, const Vector3& a_B_mps2, float dt_s) {
  Vector3 a_W = q_WB * a_B_mps2 - bias_W_mps2_;
  a_W.z() += config::kGravity_mps2;
  p_W_m_ += dt_s * v_W_mps_ + 0.5f * dt_s * dt_s * a_W;
  v_W_mps_ += dt_s * a_W;
}

void PositionFilter::correct(const Vector3& p_WB_W_m, float since_last_fix_s) {
  constexpr float kPole_radps = 5.0f;
  const float dt_s =
      std::min(since_last_fix_s, 0.1f);  // after a gap the old error is not its length
  innovation_W_m_ = p_WB_W_m - (p_W_m_ - kFixDelay_s * v_W_mps_);
  p_W_m_ += std::min(3.0f * kPole_radps * dt_s, 0.8f) * innovation_W_m_;
  v_W_mps_ += 3.0f * kPole_radps * kPole_radps * dt_s * innovation_W_m_;
  bias_W_mps2_ -= kPole_radps * kPole_radps * kPole_radps * dt_s * innovation_W_m_;
}

void PositionFilter::hold_still() {
  v_W_mps_.setZero();
}

}  // namespace fw
