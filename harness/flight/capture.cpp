#include "harness/flight/capture.hpp"

#include <algorithm>
#include <cmath>

#include "harness/base/check.hpp"

namespace whirl::flight {

Eigen::Vector3d roll_pitch_yaw_rad(const Eigen::Quaterniond& q_WB) {
  const Eigen::Matrix3d R = q_WB.toRotationMatrix();
  return {std::atan2(R(2, 1), R(2, 2)), -std::asin(std::clamp(R(2, 0), -1.0, 1.0)),
          std::atan2(R(1, 0), R(0, 0))};
}

Capture::Capture(const CaptureParams& params, std::uint64_t seed)
    : params_(params), position_(seed, "capture.position"), angle_(seed, "capture.angle") {
  WHIRL_CHECK(params.rate_Hz > 0.0, params.rate_Hz);
}

std::optional<CapturedPose> Capture::look(std::int64_t t_ns, const Eigen::Vector3d& p_WB_W_m,
                                          const Eigen::Quaterniond& q_WB) {
  const auto due_ns = std::llround(static_cast<double>(frame_) * 1e9 / params_.rate_Hz);
  if (t_ns < due_ns) return std::nullopt;
  ++frame_;
  CapturedPose pose{t_ns, t_ns + params_.latency_ns, p_WB_W_m, roll_pitch_yaw_rad(q_WB)};
  for (int i = 0; i < 3; ++i) {  // drawn also when occluded: the stream keeps its place
    pose.p_WB_W_m[i] += params_.position_noise_m * position_.normal();
    pose.roll_pitch_yaw_rad[i] += params_.angle_noise_rad * angle_.normal();
  }
  for (Occlusion& occlusion : occlusions_) {
    if (t_ns < occlusion.start_ns || t_ns >= occlusion.end_ns) continue;
    occlusion.acted = true;
    return std::nullopt;
  }
  return pose;
}

}  // namespace whirl::flight
