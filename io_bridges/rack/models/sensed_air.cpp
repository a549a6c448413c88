#include "io_bridges/rack/models/sensed_air.hpp"

#include <algorithm>

namespace whirl::rack {
namespace {

constexpr double kDryAir_JpkgK = 287.05287;  // [USSA76]

}  // namespace

void SensedAir::set(const io::BodyMotion& motion) {
  temperature_K_ = motion.air_temperature_K;
  truth_.static_pressure_Pa = motion.static_pressure_Pa;
  truth_.air_density_kgpm3 = motion.static_pressure_Pa / (kDryAir_JpkgK * temperature_K_);
  for (int i = 0; i < 3; ++i) truth_.v_AB_B_mps[i] = motion.v_AB_B_mps[i];
  std::copy(std::begin(motion.rotor_thrust_N), std::end(motion.rotor_thrust_N),
            truth_.thrust_N.begin());
}

io::Ms5611::Truth SensedAir::sense(io::Nanoseconds now) {
  const double dt_s = static_cast<double>(now - sensed_ns_) * 1e-9;
  sensed_ns_ = now;
  return {barometer_.sample_Pa(dt_s, truth_), temperature_K_};
}

}  // namespace whirl::rack
