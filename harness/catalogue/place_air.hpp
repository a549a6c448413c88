// The air of a place, as plans write it: how high it lies and how warm it is there.
//
//   { temperature = "35 degC", above_sea = "1000 m" }   each may be left out: sea level, the standard atmosphere
//   Range   -55 to 60 degC, -500 to 9000 m
#pragma once
#include "harness/lua/table.hpp"
#include "plant/air/atmosphere.hpp"

namespace whirl::catalogue {

struct PlaceAir {
  double above_sea_m = 0.0;
  double warmer_K = 0.0;  // than the standard atmosphere at that height

  plant::Atmosphere at_ground() const { return plant::standard_atmosphere(above_sea_m, warmer_K); }
};

// Reads its two keys and no others: who reads the rest finishes the table.
PlaceAir read_place_air(const lua::Table& table);

}  // namespace whirl::catalogue
