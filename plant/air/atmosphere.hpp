// The standard atmosphere up to 11 km: temperature, pressure, density, viscosity by height. And air over a
// place that is layered otherwise.
//
//   Units   SI; height is geopotential, above sea level or above the place
//   Source  [USSA76, eq. 23, 33a, 33b, 42, 51]
//   Error   printed table to its last digit; any gradient against the barometric law summed up in thin
//           slices (tests/atmosphere_test.cpp)
//   Left out moisture, and where the temperature gradient of a place ends: see layered_atmosphere()
#pragma once

namespace whirl::plant {

struct Atmosphere {
  double temperature_K = 288.15, pressure_Pa = 101325.0;
  double density_kgpm3 = 1.225, viscosity_Pas = 1.7894e-5;
};

// `warmer_K` shifts the temperature at every height; pressure at sea level stays.
Atmosphere standard_atmosphere(double height_m, double warmer_K = 0.0);

inline constexpr double kStandardGradient_Kpm = -0.0065;

// At `height_m` above a place (below: negative) that has this air, where the temperature changes by
// gradient_Kpm upwards: hydrostatic and dry. From 150 K or 400 K on it stays at that.
Atmosphere layered_atmosphere(const Atmosphere& place, double gradient_Kpm, double height_m);

}  // namespace whirl::plant
