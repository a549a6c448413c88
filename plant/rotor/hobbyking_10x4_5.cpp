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
      {0.15, 0.098, 25.44 * kDeg}, {0.20, 0.104, 23.48 * kDeg}, {0.25, 0.122, 24.58 * kDeg},
      {0.30, 0.137, 24.27 * kDeg}, {0.35, 0.150, 23.17 * kDeg}, {0.40, 0.161, 21.58 * kDeg},
      {0.45, 0.169, 19.70 * kDeg}, {0.50, 0.173, 18.18 * kDeg}, {0.55, 0.175, 16.68 * kDeg},
      {0.60, 0.174, 15.43 * kDeg}, {0.65, 0.170, 14.53 * kDeg}, {0.70, 0.163, 13.76 * kDeg},
      {0.75, 0.153, 13.06 * kDeg}, {0.80, 0.140, 12.45 * kDeg}, {0.85, 0.124, 11.78 * kDeg},
      {0.90, 0.104, 10.91 * kDeg}, {0.95, 0.075, 9.42 * kDeg},  {1.00, 0.045, 7.89 * kDeg},
  };
  d.sections = {{0.2, std::move(e63)}, {0.8, std::move(naca4412)}};
  d.induced_factor = 1.0;
  return d;
}

}  // namespace whirl::plant
