#include "plant/sensors/magnetometer.hpp"

#include <cmath>

#include "base/check.hpp"

namespace whirl::plant {

Eigen::Vector3d earth_field_W_T(double strength_T, double inclination_rad, double declination_rad) {
  const double level = strength_T * std::cos(inclination_rad);
  return {level * std::cos(declination_rad), level * std::sin(declination_rad),
          strength_T * std::sin(inclination_rad)};
}

Magnetometer::Magnetometer(const MagnetometerParams& params, std::uint64_t seed,
                           const std::string& name)
    : params_(params) {
  WHIRL_CHECK(params.per_ampere_T.size() <= kMostMotors, params.per_ampere_T.size());
  for (const char* axis : {".x", ".y", ".z"}) {
    noise_.emplace_back(params.noise_density_T, seed, name + axis);
  }
}

Eigen::Vector3d Magnetometer::sample_B_T(double dt_s, const Truth& truth) {
  const Eigen::Vector3d field_B_T = truth.q_WB.conjugate() * params_.field_W_T;
  Eigen::Vector3d felt_T = params_.soft_iron * field_B_T + params_.hard_iron_T;
  for (std::size_t i = 0; i < params_.per_ampere_T.size(); ++i)
    felt_T += params_.per_ampere_T[i] * truth.bus_current_A[i];
  for (int i = 0; i < 3; ++i) felt_T[i] += noise_[i].sample(dt_s);
  return felt_T;
}

}  // namespace whirl::plant
