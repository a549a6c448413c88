#include "harness/catalogue/place_air.hpp"

namespace whirl::catalogue {

PlaceAir read_place_air(const lua::Table& t) {
  PlaceAir air;
  air.above_sea_m =
      t.quantity_or("above_sea", Dimension::length, 0.0, lua::between(-500.0, 9000.0));
  if (t.has("temperature")) {
    const double wanted_K =
        t.quantity("temperature", Dimension::temperature, lua::between(218.15, 333.15));
    air.warmer_K = wanted_K - plant::standard_atmosphere(air.above_sea_m).temperature_K;
  }
  return air;
}

}  // namespace whirl::catalogue
