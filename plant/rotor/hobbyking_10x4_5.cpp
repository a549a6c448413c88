#include "plant/rotor/hobbyking_10x4_5.hpp"

namespace whirl::plant {

PropellerDescription hobbyking_10x4_5(std::shared_ptr<const PolarFamily> inner,
                                      std::shared_ptr<const PolarFamily> outer) {
  constexpr double kDeg = 3.14159265358979323846 / 180.0;
  PropellerDescription d;
  d.place = "hk_10x4.5";
  d.name = "Hobbyking 10x4.5 slow fly";
  d.blade_count = 2;
  d.diameter_m = 10 * 0.0254;
  d.mass_kg = 7.9e-3;
  d.stations = {
      {0.15, 0.112, 20.14 * kDeg}, {0.20, 0.137, 22.31 * kDeg}, {0.25, 0.160, 22.95 * kDeg},
      {0.30, 0.181, 22.38 * kDeg}, {0.35, 0.198, 21.23 * kDeg}, {0.40, 0.211, 19.64 * kDeg},
      {0.45, 0.221, 17.80 * kDeg}, {0.50, 0.227, 16.08 * kDeg}, {0.55, 0.230, 14.56 * kDeg},
      {0.60, 0.228, 13.21 * kDeg}, {0.65, 0.222, 12.03 * kDeg}, {0.70, 0.213, 10.97 * kDeg},
      {0.75, 0.199, 10.03 * kDeg}, {0.80, 0.181, 9.13 * kDeg},  {0.85, 0.158, 8.21 * kDeg},
      {0.90, 0.132, 7.11 * kDeg},  {0.95, 0.084, 5.78 * kDeg},  {1.00, 0.035, 4.43 * kDeg},
  };
  d.sections = {{0.2, std::move(inner)}, {0.8, std::move(outer)}};
  return d;
}

}  // namespace whirl::plant
