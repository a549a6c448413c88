#include "plant/rotor/hobbyking_10x4_5.hpp"

#include <utility>

namespace whirl::plant {

PropellerDescription hobbyking_10x4_5(std::shared_ptr<const PolarFamily> e63,
                                      std::shared_ptr<const PolarFamily> naca4412) {
  constexpr double kDeg = 3.14159265358979323846 / 180.0;
  PropellerDescription d;
  d.place = "hk_10x4.5";
  d.name = "Hobbyking 10x4.5 slow fly";
  d.blade_count = 2;
  d.diameter_m = 10 * 0.0254;
  d.mass_kg = 7.9e-3;
  d.stations = {
      {0.15, 0.099, 25.19 * kDeg}, {0.20, 0.105, 23.23 * kDeg}, {0.25, 0.123, 24.33 * kDeg},
      {0.30, 0.139, 24.02 * kDeg}, {0.35, 0.152, 22.92 * kDeg}, {0.40, 0.163, 21.33 * kDeg},
      {0.45, 0.171, 19.45 * kDeg}, {0.50, 0.176, 17.93 * kDeg}, {0.55, 0.177, 16.43 * kDeg},
      {0.60, 0.176, 15.18 * kDeg}, {0.65, 0.172, 14.28 * kDeg}, {0.70, 0.165, 13.51 * kDeg},
      {0.75, 0.155, 12.81 * kDeg}, {0.80, 0.142, 12.20 * kDeg}, {0.85, 0.126, 11.53 * kDeg},
      {0.90, 0.105, 10.66 * kDeg}, {0.95, 0.076, 9.17 * kDeg},  {1.00, 0.045, 7.64 * kDeg},
  };
  d.sections = {{0.2, std::move(e63)}, {0.8, std::move(naca4412)}};
  d.induced_factor = 1.0;
  return d;
}

}  // namespace whirl::plant
