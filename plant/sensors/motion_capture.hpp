// A camera room's pose of the vehicle.
//
//   Frame   W
//   Method  every period a frame: position and attitude with white errors, or none when occluded (by
//           window, by chance, or outside the volume)
//   Left out swapped markers, lens distortion
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "plant/sensors/gps.hpp"
#include "plant/sensors/truth.hpp"

namespace whirl::plant {

struct MotionCaptureParams {
  double period_s = 0.005;
  double position_noise_m = 3e-4;  // standard deviation per axis
  double attitude_noise_rad = 2e-3;
  double occlusion_chance = 0.0;                                // of each frame by itself, 0 to 1
  Eigen::Vector3d low_W_m = Eigen::Vector3d(-2.5, -2.0, -3.0);  // 5 x 4 x 3 m room
  Eigen::Vector3d high_W_m = Eigen::Vector3d(2.5, 2.0, 0.1);
};

struct CaptureFrame {
  double taken_s = 0.0;
  Eigen::Vector3d p_WB_W_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
};

class MotionCapture {
 public:
  MotionCapture(const MotionCaptureParams& params, std::uint64_t seed,
                const std::string& name = "mocap");
  void add_outage(const Outage& outage) { outages_.push_back(outage); }
  std::optional<CaptureFrame> step(double t_s, const Truth& truth);

 private:
  MotionCaptureParams params_;
  RandomStream position_, attitude_, chance_;
  std::vector<Outage> outages_;
  std::int64_t frames_ = 0;
};

}  // namespace whirl::plant
