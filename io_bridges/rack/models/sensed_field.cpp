#include "io_bridges/rack/models/sensed_field.hpp"

#include "plant/sensors/magnetometer.hpp"

namespace whirl::rack {

std::array<Eigen::Vector3d, io::kMostMotors> usual_motor_fields_T() {
  std::array<Eigen::Vector3d, io::kMostMotors> fields_T;
  const auto usual = plant::MagnetometerParams{}.per_ampere_T;
  for (std::size_t i = 0; i < fields_T.size(); ++i) {
    fields_T[i] = i < usual.size() ? usual[i] : Eigen::Vector3d::Zero();
  }
  return fields_T;
}

}  // namespace whirl::rack
