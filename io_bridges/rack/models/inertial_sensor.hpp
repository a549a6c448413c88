// What an IMU on the board senses between two messages of the harness.
//
//   In      BodyMotion at the boundaries; between them rate goes on with its angular acceleration
//   Out     specific force and rate in the part's own axes, which point as it is soldered
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "io_bridges/devices/mpu6000.hpp"
#include "io_bridges/messages/messages.hpp"
#include "plant/sensors/imu.hpp"

namespace whirl::rack {

using io::Nanoseconds;

// The part's axis i points along the body's axis[i], forward or (sign -1) backward.
struct Mounting {
  std::array<std::size_t, 3> axis;
  std::array<int, 3> sign;
};

Mounting mounting_of(const std::vector<std::string>& axes);  // {"+x", "-y", "-z"}
// A vector of the body in the part's axes.
std::array<double, 3> turned(const Mounting& mounting, const Eigen::Vector3d& in_B);
// And back.
std::array<double, 3> turned_back(const Mounting& mounting, const std::array<double, 3>& in_part);

class InertialSensor {
 public:
  InertialSensor(const plant::ImuParams& params, const Mounting& mounting, std::uint64_t seed,
                 const std::string& name)
      : imu_(params, seed, name), mounting_(mounting) {}

  void set_motion(const io::BodyMotion& motion, Nanoseconds t_ns) {
    motion_ = motion;
    motion_ns_ = t_ns;
  }
  io::Mpu6000::Truth sample(Nanoseconds now);

 private:
  plant::Imu imu_;
  Mounting mounting_;
  io::BodyMotion motion_{.specific_force_B_mps2 = {0.0, 0.0, -9.80665}};  // at rest
  Nanoseconds motion_ns_ = 0;
};

}  // namespace whirl::rack
