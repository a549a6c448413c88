// The lines that the tables of a stand and of a vehicle have in common: what a motor, its propeller's inertia and
// a crystal are from copy to copy. Each table has its own groups.
#pragma once
#include "plant/parts/part_number.hpp"

namespace whirl::plant::parts {

constexpr PartNumber torque_constant(const char* group) {
  return {group,
          "torque_constant",
          "",
          true,
          {Spread::Law::normal, 0.0, 0.02, 0.05},
          "makers' Kv, within 5 %"};
}
constexpr PartNumber resistance(const char* group) {
  return {group,
          "resistance",
          "",
          true,
          {Spread::Law::normal, 0.0, 0.04, 0.10},
          "estimate: winding 3 %, switches' 20 % of a third of it, plugs and solder"};
}
constexpr PartNumber no_load_current(const char* group) {
  return {group,
          "no_load_current",
          "",
          true,
          {Spread::Law::normal, 0.0, 0.10, 0.30},
          "makers' no-load currents of one type differ by a tenth"};
}
constexpr PartNumber inertia(const char* group) {
  return {group,
          "inertia",
          "",
          true,
          {Spread::Law::normal, 0.0, 0.02, 0.05},
          "propellers weigh within 5 %"};
}
constexpr PartNumber heat_capacity(const char* group) {
  return {group,
          "heat_capacity",
          "J/K",
          false,
          {Spread::Law::normal, 18.0, 2.0, 5.0},
          "estimate: 12 g of copper (0.385 J/gK) and 30 g of iron (0.45 J/gK) in a motor of 70 g"};
}
constexpr PartNumber bearing_share(const char* group) {
  return {group,
          "bearing_share",
          "",
          false,
          {Spread::Law::normal, 0.3, 0.05, 0.15},
          "estimate: grease of two 3 mm bearings beside the iron"};
}
constexpr PartNumber hse_error(const char* group) {
  return {group,
          "hse_error",
          "",
          false,
          {Spread::Law::normal, 0.0, 15e-6, 50e-6},
          "crystal: 30 ppm cut, 20 ppm over temperature"};
}

}  // namespace whirl::plant::parts
