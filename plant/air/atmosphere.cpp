#include "plant/air/atmosphere.hpp"

#include <cmath>

#include "plant/base/frames.hpp"

namespace whirl::plant {
namespace {

constexpr double kGas_JpkgK = 8314.32 / 28.9644;  // [USSA76] keeps the older gas constant
constexpr double kLapse_Kpm = 0.0065;

}  // namespace

Atmosphere standard_atmosphere(double height_m, double warmer_K) {
  const double ground_K = 288.15 + warmer_K;
  Atmosphere air;
  air.temperature_K = ground_K - kLapse_Kpm * height_m;
  air.pressure_Pa =
      101325.0 * std::pow(air.temperature_K / ground_K, kGravity_mps2 / (kGas_JpkgK * kLapse_Kpm));
  air.density_kgpm3 = air.pressure_Pa / (kGas_JpkgK * air.temperature_K);
  air.viscosity_Pas =
      1.458e-6 * air.temperature_K * std::sqrt(air.temperature_K) / (air.temperature_K + 110.4);
  return air;
}

}  // namespace whirl::plant
