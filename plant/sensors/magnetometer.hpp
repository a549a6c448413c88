// The magnetic field at the sensor: the earth's, what the frame adds and bends, what the motors' supply
// currents make.
//
//   Frame   B; the field of a place is given in W
//   Units   T
//   Method  soft x (R_BW field) + hard + sum of (field per ampere) x bus current + white noise
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "plant/sensors/noise.hpp"
#include "plant/sensors/truth.hpp"

namespace whirl::plant {

// Of declination (east positive), inclination (down positive) and strength.
Eigen::Vector3d earth_field_W_T(double strength_T, double inclination_rad, double declination_rad);

struct MagnetometerParams {
  Eigen::Vector3d field_W_T = Eigen::Vector3d(23.9e-6, 5.2e-6, -52.5e-6);  // Canberra
  Eigen::Matrix3d soft_iron = Eigen::Matrix3d::Identity();
  Eigen::Vector3d hard_iron_T = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> per_ampere_T{
      // of the motors that it feels; at most kMostMotors
      Eigen::Vector3d(4e-8, 0.0, 2e-8), Eigen::Vector3d(0.0, 4e-8, 2e-8),
      Eigen::Vector3d(-4e-8, 0.0, 2e-8), Eigen::Vector3d(0.0, -4e-8, 2e-8)};
  double noise_density_T = 2e-8;  // per root Hz
};

class Magnetometer {
 public:
  Magnetometer(const MagnetometerParams& params, std::uint64_t seed,
               const std::string& name = "mag");
  Eigen::Vector3d sample_B_T(double dt_s, const Truth& truth);

 private:
  MagnetometerParams params_;
  std::vector<WhiteNoise> noise_;
};

}  // namespace whirl::plant
