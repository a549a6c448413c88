#include "plant/air/atmosphere.hpp"

#include <algorithm>
#include <cmath>

#include "plant/base/frames.hpp"

namespace whirl::plant {
namespace {

constexpr double kGas_JpkgK = 8314.32 / 28.9644;  // [USSA76] keeps the older gas constant
constexpr double kLapse_Kpm = -kStandardGradient_Kpm;
constexpr double kColdest_K = 150.0, kWarmest_K = 400.0;
constexpr double kNo_gradient_Kpm = 1e-9;  // a kilometre of it is a millionth of a kelvin

// Of a temperature and a pressure that are set.
void put_density_and_viscosity(Atmosphere& air) {
  air.density_kgpm3 = air.pressure_Pa / (kGas_JpkgK * air.temperature_K);
  air.viscosity_Pas =
      1.458e-6 * air.temperature_K * std::sqrt(air.temperature_K) / (air.temperature_K + 110.4);
}

// Upwards through air of one temperature.
double isothermal(double pressure_Pa, double temperature_K, double up_m) {
  return pressure_Pa * std::exp(-kGravity_mps2 * up_m / (kGas_JpkgK * temperature_K));
}

}  // namespace

Atmosphere standard_atmosphere(double height_m, double warmer_K) {
  const double ground_K = 288.15 + warmer_K;
  Atmosphere air;
  air.temperature_K = ground_K - kLapse_Kpm * height_m;
  air.pressure_Pa =
      101325.0 * std::pow(air.temperature_K / ground_K, kGravity_mps2 / (kGas_JpkgK * kLapse_Kpm));
  put_density_and_viscosity(air);
  return air;
}

Atmosphere layered_atmosphere(const Atmosphere& place, double gradient_Kpm, double height_m) {
  Atmosphere air = place;
  double layer_m = 0.0;  // of the height, as far as the gradient goes
  if (std::abs(gradient_Kpm) > kNo_gradient_Kpm) {
    const double wanted_K = place.temperature_K + gradient_Kpm * height_m;
    air.temperature_K = std::clamp(wanted_K, kColdest_K, kWarmest_K);
    layer_m = (air.temperature_K - place.temperature_K) / gradient_Kpm;
    air.pressure_Pa *= std::pow(air.temperature_K / place.temperature_K,
                                -kGravity_mps2 / (kGas_JpkgK * gradient_Kpm));
  }
  air.pressure_Pa = isothermal(air.pressure_Pa, air.temperature_K, height_m - layer_m);
  put_density_and_viscosity(air);
  return air;
}

}  // namespace whirl::plant
