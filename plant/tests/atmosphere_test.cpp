#include "plant/air/atmosphere.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace whirl::plant
