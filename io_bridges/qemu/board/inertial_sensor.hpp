// What an IMU on the board feels between two messages of the harness.
//
//   In      BodyMotion at the boundaries; between them rate goes on with its angular acceleration
//   Out     specific force and rate in the MPU-6000's axes: x forward, y left, z up
//   Params  noise figures and place by name (accel_noise_density, p_BS_B_m.0, ...); see .cpp
#pragma once
#include <cstdint>
#include <map>
#include <string>

#include "base/result.hpp"
#include "io_bridges/devices/mpu6000.hpp"
#include "io_bridges/messages/messages.hpp"
#include "plant/sensors/imu.hpp"

namespace whirl::board {

using io::Nanoseconds;

Result<plant::ImuParams> imu_params(const std::map<std::string, double>& params,
                                    const std::string& place);

class InertialSensor {
 public:
  InertialSensor(const plant::ImuParams& params, std::uint64_t seed, const std::string& name)
      : imu_(params, seed, name) {}

  void set_motion(const io::BodyMotion& motion, Nanoseconds t_ns) {
    motion_ = motion;
    motion_ns_ = t_ns;
  }
  io::Mpu6000::Truth feel(Nanoseconds now);

 private:
  plant::Imu imu_;
  io::BodyMotion motion_{.specific_force_B_mps2 = {0.0, 0.0, -9.80665}};  // at rest
  Nanoseconds motion_ns_ = 0;
};

}  // namespace whirl::board
