#include "plant/air/atmosphere.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"

namespace whirl::plant {
namespace {

// The standard's values by geopotential height [USSA76, table I]; the last digit of each column
// sets its tolerance.
struct Row {
  double h_m, T_K, p_hPa, rho_kgpm3, rho_digit;
};
constexpr Row kTable[] = {
    {0.0, 288.150, 1013.250, 1.2250, 1e-4},     {1000.0, 281.650, 898.746, 1.1116, 1e-4},
    {2000.0, 275.150, 794.952, 1.0065, 1e-4},   {5000.0, 255.650, 540.199, 0.73612, 1e-5},
    {10000.0, 223.150, 264.363, 0.41271, 1e-5}, {11000.0, 216.650, 226.321, 0.36392, 1e-5},
};

TEST(Atmosphere, ReproducesTheStandardsTable) {
  for (const Row& row : kTable) {
    const Atmosphere air = standard_atmosphere(row.h_m);
    EXPECT_TRUE(near(air.temperature_K, row.T_K, printed_to(1e-3))) << row.h_m;
    EXPECT_TRUE(near(air.pressure_Pa / 100.0, row.p_hPa, printed_to(1.01e-3))) << row.h_m;
    EXPECT_TRUE(near(air.density_kgpm3, row.rho_kgpm3, printed_to(row.rho_digit))) << row.h_m;
  }
  EXPECT_TRUE(near(standard_atmosphere(0.0).viscosity_Pas, 1.7894e-5, printed_to(1e-9)));
}

TEST(Atmosphere, WarmAirIsThinAndFallsOffMoreSlowly) {
  const Atmosphere cold = standard_atmosphere(1000.0), warm = standard_atmosphere(1000.0, 20.0);
  EXPECT_GT(warm.pressure_Pa, cold.pressure_Pa);
  EXPECT_LT(warm.density_kgpm3, cold.density_kgpm3);
}

// dp = -rho g dh with rho = p / (R T), slice by slice of a centimetre at the middle's temperature.
double weighed_Pa(double ground_Pa, double ground_K, double gradient_Kpm, double height_m) {
  const double slice_m = height_m / 1e4;
  double log_p = std::log(ground_Pa);
  for (int i = 0; i < 10'000; ++i) {
    log_p -= 9.80665 * slice_m / (287.053 * (ground_K + gradient_Kpm * (i + 0.5) * slice_m));
  }
  return std::exp(log_p);
}

TEST(Atmosphere, PressureIsTheWeightOfTheLayeredAirAbove) {
  Atmosphere ground = standard_atmosphere(600.0, -30.0);
  for (const double gradient_Kpm : {-0.03, -0.0065, 0.0, 0.05}) {
    for (const double height_m : {-20.0, 20.0, 100.0, 1000.0}) {
      const Atmosphere air = layered_atmosphere(ground, gradient_Kpm, height_m);
      const double want_Pa =
          weighed_Pa(ground.pressure_Pa, ground.temperature_K, gradient_Kpm, height_m);
      EXPECT_TRUE(near(air.pressure_Pa, want_Pa, stated(0.02, "the gas constant's sixth digit")))
          << gradient_Kpm << ", " << height_m;
      EXPECT_TRUE(near(air.temperature_K, ground.temperature_K + gradient_Kpm * height_m,
                       round_off(8, 300.0)));
      EXPECT_TRUE(near(air.density_kgpm3, air.pressure_Pa / (287.053 * air.temperature_K),
                       stated(1e-5, "the gas constant's sixth digit")));
    }
  }
}

TEST(Atmosphere, TheStandardsOwnGradientIsTheStandard) {
  for (const double height_m : {-100.0, 20.0, 3000.0}) {
    const Atmosphere want = standard_atmosphere(600.0 + height_m, 12.0);
    const Atmosphere air =
        layered_atmosphere(standard_atmosphere(600.0, 12.0), kStandardGradient_Kpm, height_m);
    EXPECT_TRUE(near(air.pressure_Pa, want.pressure_Pa, round_off(64, 1e5)));
    EXPECT_TRUE(near(air.density_kgpm3, want.density_kgpm3, round_off(64, 1.0)));
    EXPECT_TRUE(near(air.viscosity_Pas, want.viscosity_Pas, round_off(64, 1e-5)));
  }
}

// A barometer that is read by the standard atmosphere makes T_std / T of a height: 16.1 % too much at -25 degC.
TEST(Atmosphere, ColdAirMakesABarometersHeightTooLargeByTheRatioOfTemperatures) {
  const Atmosphere ground = standard_atmosphere(0.0, -40.0);  // 248.15 K
  const Atmosphere up = layered_atmosphere(ground, 0.0, 20.0);
  const auto read_m = [](double pressure_Pa) {
    return 44330.8 * (1.0 - std::pow(pressure_Pa / 101325.0, 0.190263));
  };
  EXPECT_TRUE(near((read_m(up.pressure_Pa) - read_m(ground.pressure_Pa)) / 20.0, 288.15 / 248.15,
                   stated(5e-4, "the standard's own 0.07 K over the half of 20 m")));
}

// 0.2 K/m downwards would be 0 K in 1400 m.
TEST(Atmosphere, NoGradientEndsTheAir) {
  for (const double gradient_Kpm : {-0.2, 0.2}) {
    double last_Pa = 1e9;
    for (double height_m = -3000.0; height_m <= 5000.0; height_m += 100.0) {
      const Atmosphere air = layered_atmosphere(standard_atmosphere(0.0), gradient_Kpm, height_m);
      EXPECT_GE(air.temperature_K, 150.0);
      EXPECT_LE(air.temperature_K, 400.0);
      EXPECT_LT(air.pressure_Pa, last_Pa);
      EXPECT_GT(air.pressure_Pa, 0.0);
      last_Pa = air.pressure_Pa;
    }
  }
}

}  // namespace
}  // namespace whirl::plant
