// The motion-capture system: the pose of the vehicle as cameras find it.
//
//   In       true pose, frames W and B (plant/frames.hpp)
//   Out      a pose with white noise, at most one per period, late by latency_ns; none while it is
//            occluded
//   Left out marker swaps, slow drift of the calibration
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "harness/base/random.hpp"

namespace whirl::flight {

struct CaptureParams {
  double rate_Hz = 40.0;
  std::int64_t latency_ns = 8'000'000;  // exposure to the radio's input
  double position_noise_m = 0.001;      // one sigma, each axis
  double angle_noise_rad = 0.002;
};

struct CapturedPose {
  std::int64_t exposed_ns = 0, sent_ns = 0;
  Eigen::Vector3d p_WB_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d roll_pitch_yaw_rad = Eigen::Vector3d::Zero();
};

struct Occlusion {
  std::uint32_t fault = 0;
  std::int64_t start_ns = 0, end_ns = 0;
  bool acted = false;
};

Eigen::Vector3d roll_pitch_yaw_rad(const Eigen::Quaterniond& q_WB);

class Capture {
 public:
  Capture(const CaptureParams& params, std::uint64_t seed);

  void occlude(const Occlusion& occlusion) { occlusions_.push_back(occlusion); }
  const std::vector<Occlusion>& occlusions() const { return occlusions_; }

  // Asked at each step; gives a pose when one is due at t_ns and the cameras see the vehicle.
  std::optional<CapturedPose> look(std::int64_t t_ns, const Eigen::Vector3d& p_WB_W_m,
                                   const Eigen::Quaterniond& q_WB);

 private:
  CaptureParams params_;
  std::vector<Occlusion> occlusions_;
  std::int64_t frame_ = 0;
  RandomStream position_, angle_;
};

}  // namespace whirl::flight
