// Velocity through the air from what drag does to the accelerometer.
//
//   Model    a_xy / a_z = (c + k |v|) v: rotors [Bangura 2017, 4.22] and frame [4.4.5], along x and y of B
//   k        of the frame, config::kFrameDrag_s2pm2: a hundredth of the rotors' at 0.5 m/s, and 7 % at 3 m/s
#pragma once
#include "firmware/config/vehicle.hpp"
#include "firmware/math.hpp"

namespace fw {

// y: a_xy / a_z. Of |y| = (c + k s) s the positive root s.
inline Eigen::Vector2f velocity_through_air(const Eigen::Vector2f& y, float drag_spm) {
  const float root = std::sqrt(drag_spm * drag_spm + 4.0f * config::kFrameDrag_s2pm2 * y.norm());
  return 2.0f / (drag_spm + root) * y;
}

}  // namespace fw
