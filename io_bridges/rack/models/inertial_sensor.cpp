#include "io_bridges/rack/models/inertial_sensor.hpp"

#include <algorithm>

#include "base/check.hpp"
#include "plant/base/motor_count.hpp"

namespace whirl::rack {

static_assert(io::kMostMotors == plant::kMostMotors);

Mounting mounting_of(const std::vector<std::string>& axes) {
  WHIRL_CHECK(axes.size() == 3, axes.size());
  Mounting mounting{};
  for (std::size_t i = 0; i < 3; ++i) {
    WHIRL_CHECK(axes[i].size() == 2 && axes[i][1] >= 'x' && axes[i][1] <= 'z', axes[i]);
    mounting.axis[i] = static_cast<std::size_t>(axes[i][1] - 'x');
    mounting.sign[i] = axes[i][0] == '-' ? -1 : 1;
  }
  return mounting;
}

std::array<double, 3> turned(const Mounting& mounting, const Eigen::Vector3d& in_B) {
  std::array<double, 3> out{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double along = in_B[static_cast<Eigen::Index>(mounting.axis[i])];
    out[i] = mounting.sign[i] > 0 ? along : -along;
  }
  return out;
}

std::array<double, 3> turned_back(const Mounting& mounting, const std::array<double, 3>& in_part) {
  std::array<double, 3> out{};
  for (std::size_t i = 0; i < 3; ++i) {
    out[mounting.axis[i]] = mounting.sign[i] > 0 ? in_part[i] : -in_part[i];
  }
  return out;
}

io::Mpu6000::Truth InertialSensor::sample(Nanoseconds now) {
  const double dt_s = static_cast<double>(now - motion_ns_) * 1e-9;
  plant::ImuMotion motion;
  for (int i = 0; i < 3; ++i) {
    motion.specific_force_B_mps2[i] = motion_.specific_force_B_mps2[i];
    motion.alpha_WB_B_radps2[i] = motion_.alpha_WB_B_radps2[i];
    motion.w_WB_B_radps[i] = motion_.w_WB_B_radps[i] + motion_.alpha_WB_B_radps2[i] * dt_s;
  }
  std::copy(std::begin(motion_.rotor_speed_radps), std::end(motion_.rotor_speed_radps),
            motion.rotor_speed_radps.begin());
  std::copy(std::begin(motion_.rotor_unbalance_m), std::end(motion_.rotor_unbalance_m),
            motion.unbalance_m.begin());
  const plant::ImuSample sensed = imu_.sample(static_cast<double>(now) * 1e-9, motion);
  return {turned(mounting_, sensed.specific_force_S_mps2), turned(mounting_, sensed.rate_S_radps),
          motion_.air_temperature_K};
}

}  // namespace whirl::rack
