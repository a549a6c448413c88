// The thesis's propeller as a description; the same numbers as test_plans/propellers/hk_10x4.5.lua.
//
//   Source  no drawing of this blade is published: planform and twist are those of the measured
//           APC 11x4.7 slow flyer, turned until the static thrust of [Thesis, 3.5] is met.
//   Error   thrust within 3 % of T = 1.789e-7 w^2 - 1.4715e-4 w (RPM) from 3000 to 5500 RPM.
#pragma once
#include <memory>

#include "plant/rotor/blade.hpp"

namespace whirl::plant {

// Sections: Eppler E63 inboard, NACA 4412 outboard.
PropellerDescription hobbyking_10x4_5(std::shared_ptr<const PolarFamily> inner,
                                      std::shared_ptr<const PolarFamily> outer);

}  // namespace whirl::plant
