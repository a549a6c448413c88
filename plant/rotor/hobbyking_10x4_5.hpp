// The thesis's propeller as a description; the same numbers as test_plans/propellers/hk_10x4.5.lua.
//
//   Source  no drawing of this blade is published. Planform and twist are those of the measured APC
//           9x4.7 slow flyer [UiucProp], chord x 0.78 and angle + 0.95 deg + 6 deg (r/R - 0.7), set
//           so that three things are met at once: the static thrust of [Bangura2017, 3.5], a
//           figure of merit near the 0.68 to 0.71 that its bus current means, and the loss of
//           thrust with inflow that measured slow flyers show. Sections E63 to NACA 4412; the
//           figure of merit asks for the ideal ring (induced_factor 1).
//   Error   thrust within 3 % of T = 1.789e-7 w^2 - 1.4715e-4 w (RPM) from 3000 to 5500 RPM, figure of
//           merit 0.6 to 0.75 (tests/hobbyking_test.cpp).
#pragma once
#include <memory>

#include "plant/rotor/blade.hpp"

namespace whirl::plant {

PropellerDescription hobbyking_10x4_5(std::shared_ptr<const PolarFamily> e63,
                                      std::shared_ptr<const PolarFamily> naca4412);

}  // namespace whirl::plant
