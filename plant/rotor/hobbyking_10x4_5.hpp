// The thesis's propeller as a description; the same numbers as test_plans/propellers/hk_10x4.5.lua.
//
//   Source  no drawing of this blade is published. It is a copy of the thin GWS slow flyers, so
//           planform and twist are those of the measured GWS 11x4.7 [UiucProp], chord x 0.66 and
//           angle + 2.2 deg - 10 deg (r/R - 0.7), in nylon as GWS, sections BW-3 to E63, set so that four
//           things are met at once: the static thrust of [Bangura2017, 3.5], a figure of merit near
//           what its bus current means, the loss of thrust with inflow of Table 5.6 and of measured
//           slow flyers, and a power that falls with inflow as theirs does.
//   Error   thrust within 3 % of T = 1.789e-7 w^2 - 1.4715e-4 w (RPM) from 3000 to 5500 RPM, figure of
//           merit 0.6 to 0.75 (tests/hobbyking_test.cpp).
#pragma once
#include <memory>

#include "plant/rotor/blade.hpp"

namespace whirl::plant {

PropellerDescription hobbyking_10x4_5(std::shared_ptr<const PolarFamily> bw3,
                                      std::shared_ptr<const PolarFamily> e63);

}  // namespace whirl::plant
