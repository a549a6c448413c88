// The standard atmosphere up to 11 km: temperature, pressure, density, viscosity by height.
//
//   Units   SI; height is geopotential, above sea level
//   Source  [USSA76, eq. 23, 33a, 42, 51]
//   Error   printed table to its last digit (tests/atmosphere_test.cpp)
#pragma once

namespace whirl::plant {

struct Atmosphere {
  double temperature_K = 288.15, pressure_Pa = 101325.0;
  double density_kgpm3 = 1.225, viscosity_Pas = 1.7894e-5;
};

// `warmer_K` shifts the temperature at every height; pressure at sea level stays.
Atmosphere standard_atmosphere(double height_m, double warmer_K = 0.0);

}  // namespace whirl::plant
