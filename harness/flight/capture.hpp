// The motion-capture system as the radio sees it: the cameras' newest pose, passed on at the radio's
// own rate and late.
//
//   In       true pose, frames W and B (plant/base/frames.hpp)
//   Out      at most one pose per radio period, latency_ns after its exposure; none while it is
//            occluded or out of the room (plant/sensors/motion_capture.hpp)
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "plant/sensors/motion_capture.hpp"

namespace whirl::flight {

struct CaptureParams {
  plant::MotionCaptureParams cameras;
  double rate_Hz = 40.0;                // to the vehicle
  std::int64_t latency_ns = 8'000'000;  // exposure to the radio's input
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

  // Asked at each step; gives a pose when the radio wants one and the cameras have a new one.
  std::optional<CapturedPose> look(std::int64_t t_ns, const plant::Truth& truth);

 private:
  bool occluded(std::int64_t t_ns);

  CaptureParams params_;
  plant::MotionCapture cameras_;
  std::vector<Occlusion> occlusions_;
  std::optional<plant::CaptureFrame> newest_;  // not yet passed on
  std::int64_t asked_ = 0;                     // radio periods so far
};

}  // namespace whirl::flight
