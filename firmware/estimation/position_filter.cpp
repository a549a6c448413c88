#include "firmware/estimation/position_filter.hpp"

#include "firmware/config/vehicle.hpp"

namespace fw {

void PositionFilter::start(const Vector3& p_WB_W_m) {
  p_W_m_ = p_WB_W_m;
  v_W_mps_.setZero();
  bias_W_mps2_.setZero();
  innovation_W_m_.setZero();
  history_.fill({p_WB_W_m, Vector3::Zero()});
}

void PositionFilter::predict(const Quaternion& q_WB, const Vector3& a_B_mps2, float dt_s) {
  Vector3 a_W = q_WB * a_B_mps2 - bias_W_mps2_;
  a_W.z() += config::kGravity_mps2;
  p_W_m_ += dt_s * v_W_mps_ + 0.5f * dt_s * dt_s * a_W;
  v_W_mps_ += dt_s * a_W;
  newest_ = (newest_ + 1) % kHistory;
  history_[newest_] = {p_W_m_, v_W_mps_};
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
  bias_W_mps2_.setZero();
}

PositionFilter::Innovation PositionFilter::gps_innovation(const Vector3& p_WB_W_m,
                                                          const Vector3& v_WB_W_mps,
                                                          float delay_s) const {
  constexpr float kStep_s = 0.005f;
  const auto steps =
      static_cast<unsigned>(std::lround(std::clamp(delay_s, 0.0f, kLongestDelay_s) / kStep_s));
  const Moment& then = history_[(newest_ + kHistory - steps) % kHistory];
  return {p_WB_W_m - then.p_W_m, v_WB_W_mps - then.v_W_mps};
}

void PositionFilter::correct_by_gps(const Innovation& innovation, float since_last_s) {
  constexpr float kPlace_ps = 5.0f, kPlaceToVelocity_ps2 = 2.0f, kVelocity_ps = 1.5f,
                  kBias_ps2 = 0.2f, kLongest_s = 0.25f;
  const float dt_s = std::min(since_last_s, kLongest_s);
  innovation_W_m_ = {innovation.p_W_m.x(), innovation.p_W_m.y(), 0.0f};
  p_W_m_ += dt_s * kPlace_ps * innovation_W_m_;
  v_W_mps_ += dt_s * (kPlaceToVelocity_ps2 * innovation_W_m_ + kVelocity_ps * innovation.v_W_mps);
  bias_W_mps2_ -= dt_s * kBias_ps2 * innovation.v_W_mps;
}

void PositionFilter::set_height(float z_m, float vz_mps) {
  p_W_m_.z() = z_m;
  v_W_mps_.z() = vz_mps;
  bias_W_mps2_.z() = 0.0f;
}

}  // namespace fw
