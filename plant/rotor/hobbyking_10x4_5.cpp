#include "plant/rotor/hobbyking_10x4_5.hpp"

#include <utility>

#include "base/angles.hpp"

namespace whirl::plant {

PropellerDescription hobbyking_10x4_5(std::shared_ptr<const PolarFamily> bw3,
                                      std::shared_ptr<const PolarFamily> e63) {
  PropellerDescription d;
  d.place = "hk_10x4.5";
  d.name = "Hobbyking 10x4.5 slow fly";
  d.blade_count = 2;
  d.diameter_m = 10 * 0.0254;
  d.mass_kg = 7.9e-3;
  d.stations = {
      {0.15, 0.0680, 25.01 * kDeg}, {0.20, 0.0799, 27.03 * kDeg}, {0.25, 0.0957, 27.58 * kDeg},
      {0.30, 0.1122, 26.71 * kDeg}, {0.35, 0.1274, 25.61 * kDeg}, {0.40, 0.1393, 23.93 * kDeg},
      {0.45, 0.1472, 21.75 * kDeg}, {0.50, 0.1505, 19.54 * kDeg}, {0.55, 0.1525, 17.57 * kDeg},
      {0.60, 0.1511, 16.01 * kDeg}, {0.65, 0.1485, 14.72 * kDeg}, {0.70, 0.1432, 13.55 * kDeg},
      {0.75, 0.1346, 12.43 * kDeg}, {0.80, 0.1234, 11.41 * kDeg}, {0.85, 0.1096, 10.36 * kDeg},
      {0.90, 0.0917, 9.42 * kDeg},  {0.95, 0.0640, 8.63 * kDeg},  {1.00, 0.0363, 7.86 * kDeg},
  };
  d.sections = {{0.2, std::move(bw3)}, {0.9, std::move(e63)}};
  d.induced_factor = 1.13;
  d.material = kNylon;
  d.thickness_over_chord = 0.065;
  return d;
}

}  // namespace whirl::plant
