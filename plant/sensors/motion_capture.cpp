#include "plant/sensors/motion_capture.hpp"

#include <algorithm>

namespace whirl::plant {

MotionCapture::MotionCapture(const MotionCaptureParams& params, std::uint64_t seed,
                             const std::string& name)
    : params_(params),
      position_(seed, name + ".position"),
      attitude_(seed, name + ".attitude"),
      chance_(seed, name + ".occlusion") {}

std::optional<CaptureFrame> MotionCapture::step(double t_s, const Truth& truth) {
  if (t_s + 1e-9 < static_cast<double>(frames_) * params_.period_s) return std::nullopt;
  ++frames_;
  CaptureFrame frame{.taken_s = t_s, .p_WB_W_m = truth.p_WB_W_m, .q_WB = truth.q_WB};
  Eigen::Vector3d turn;
  for (int i = 0; i < 3; ++i) {
    frame.p_WB_W_m[i] += params_.position_noise_m * position_.normal();
    turn[i] = 0.5 * params_.attitude_noise_rad * attitude_.normal();
  }
  frame.q_WB = (truth.q_WB * Eigen::Quaterniond(1.0, turn.x(), turn.y(), turn.z())).normalized();
  const bool unlucky = chance_.uniform() < params_.occlusion_chance;
  const bool out =
      std::any_of(outages_.begin(), outages_.end(), [&](const Outage& o) { return o.covers(t_s); });
  const bool outside = (truth.p_WB_W_m.array() < params_.low_W_m.array()).any() ||
                       (truth.p_WB_W_m.array() > params_.high_W_m.array()).any();
  if (unlucky || out || outside) return std::nullopt;
  return frame;
}

}  // namespace whirl::plant
