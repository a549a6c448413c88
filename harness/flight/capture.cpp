#include "harness/flight/capture.hpp"

#include <algorithm>
#include <cmath>

#include "base/check.hpp"

namespace whirl::flight {

Eigen::Vector3d roll_pitch_yaw_rad(const Eigen::Quaterniond& q_WB) {
  const Eigen::Matrix3d R = q_WB.toRotationMatrix();
  return {std::atan2(R(2, 1), R(2, 2)), -std::asin(std::clamp(R(2, 0), -1.0, 1.0)),
          std::atan2(R(1, 0), R(0, 0))};
}

Capture::Capture(const CaptureParams& params, std::uint64_t seed)
    : params_(params), cameras_(params.cameras, seed) {
  WHIRL_CHECK(params.rate_Hz > 0.0, params.rate_Hz);
}

std::optional<CapturedPose> Capture::look(std::int64_t t_ns, const plant::Truth& truth,
                                          const std::function<bool()>& hidden) {
  // The cameras go on drawing their errors while hidden: a fault does not shift later ones.
  const auto frame = cameras_.step(static_cast<double>(t_ns) * 1e-9, truth);
  if (frame && !hidden()) newest_ = frame;
  const auto due_ns = std::llround(static_cast<double>(asked_) * 1e9 / params_.rate_Hz);
  if (t_ns < due_ns) return std::nullopt;
  ++asked_;
  if (!newest_) return std::nullopt;
  const std::int64_t exposed_ns = std::llround(newest_->taken_s * 1e9);
  const CapturedPose pose{exposed_ns, exposed_ns + params_.latency_ns, newest_->p_WB_W_m,
                          roll_pitch_yaw_rad(newest_->q_WB)};
  newest_.reset();
  ++passed_on_;
  return pose;
}

}  // namespace whirl::flight
