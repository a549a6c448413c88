// How fast the thrust of one copy can rise at best: from 10 to 90 % of a step while its windings carry one mean
// current throughout. The floor under every controller that keeps to that current.
//
//   Units    SI; wind positive from above
//   Method   J w' = Kt (i - no load) - torque of the air, by the plant's own rotor with the lag of its inflow, from
//            where both are steady
//   Valid    between two steady thrusts in one wind. What the supply's voltage leaves is not asked
//   Error    against a closed form: tests/current_bound_test.cpp
//   Left out warmth: Kt and friction as at 20 degC (magnets 20 K warmer give 2 % less), cogging, ripple
#pragma once
#include <memory>

#include "base/result.hpp"
#include "plant/motor/motor_params.hpp"
#include "plant/rotor/blade.hpp"
#include "plant/rotor/rotor.hpp"

namespace whirl::stand {

struct RiseAsked {
  double from_N = 0.0, to_N = 0.0, current_A = 0.0, wind_mps = 0.0;
  plant::RotorConditions still = {};  // the air's density and viscosity
};

// Errors  bad_input: no rise, or one that this current does not bring about
Result<double> shortest_rise_s(const plant::MotorParams& motor,
                               const std::shared_ptr<const plant::Blade>& blade,
                               const RiseAsked& asked);

}  // namespace whirl::stand
