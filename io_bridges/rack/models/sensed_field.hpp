// The field where a magnetometer is, as it is soldered: the earth's as the frame bends it, what the frame adds,
// and what currents do, per ampere, means over a millisecond (plant/sensors/magnetometer.hpp).
#pragma once
#include <array>

#include "io_bridges/messages/messages.hpp"
#include "io_bridges/rack/models/inertial_sensor.hpp"

namespace whirl::rack {

struct FieldParams {
  Mounting mounting;
  Eigen::Vector3d hard_iron_B_T = Eigen::Vector3d::Zero();
  Eigen::Vector3d pack_per_ampere_T = Eigen::Vector3d::Zero();
  Eigen::Matrix3d soft_iron = Eigen::Matrix3d::Identity();
  std::array<Eigen::Vector3d, io::kMostMotors> per_ampere_T;  // index: motor number - 1
};
// Of the plant's usual motors; the others make none.
std::array<Eigen::Vector3d, io::kMostMotors> usual_motor_fields_T();

class SensedField {
 public:
  explicit SensedField(const FieldParams& params) : params_(params) {}

  void set(const io::BodyMotion& motion) {
    field_B_T_ = params_.soft_iron * Eigen::Vector3d(motion.magnetic_field_B_T) +
                 params_.pack_per_ampere_T * motion.battery_current_A;
    for (std::size_t i = 0; i < params_.per_ampere_T.size(); ++i) {
      field_B_T_ += params_.per_ampere_T[i] * motion.rotor_bus_current_A[i];
    }
  }
  std::array<double, 3> along_part_T() const {
    return turned(params_.mounting, field_B_T_ + params_.hard_iron_B_T);
  }
  const Mounting& mounting() const { return params_.mounting; }

 private:
  FieldParams params_;
  Eigen::Vector3d field_B_T_ = Eigen::Vector3d::Zero();
};

}  // namespace whirl::rack
