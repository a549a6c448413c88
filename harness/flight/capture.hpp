// The motion-capture system as the radio sees it: the cameras' newest pose, passed on at the radio's
// own rate and late.
//
//   In       true pose, frames W and B (plant/base/frames.hpp)
//   Out      at most one pose per radio period, latency_ns after its exposure; none where all frames since
//            the last were occluded or out of the room (plant/sensors/motion_capture.hpp): of a chance p a frame
//            p^n of the poses, n frames in a radio period (200 Hz of 40 Hz: 5)
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <optional>

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

Eigen::Vector3d roll_pitch_yaw_rad(const Eigen::Quaterniond& q_WB);

class Capture {
 public:
  Capture(const CaptureParams& params, std::uint64_t seed);

  // Asked at each step; gives a pose when the radio wants one and the cameras have a new one. `hidden`
  // is asked of each frame that the cameras have taken: whether something is in their way.
  std::optional<CapturedPose> look(std::int64_t t_ns, const plant::Truth& truth,
                                   const std::function<bool()>& hidden);
  std::int64_t passed_on() const { return passed_on_; }  // poses so far

 private:
  CaptureParams params_;
  plant::MotionCapture cameras_;
  std::optional<plant::CaptureFrame> newest_;  // not yet passed on
  std::int64_t asked_ = 0;                     // radio periods so far
  std::int64_t passed_on_ = 0;
};

}  // namespace whirl::flight
