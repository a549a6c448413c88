// A propeller file's blade: traits by what is known of blades like it and by its own static rows.
//
//   In       description.known, stations, static_points and flight_points (CP where measured); no sections
//   Out      the blade to fly, how sure its traits are, what the static rows leave over, and what to doubt
//   Refused  static thrust that is left over by more than 10 %, tip twist beyond -3 to 6 deg; static rows more than 8
//            standard deviations off what blades of this shape give (of the 44 and the fifteen of data/outside none is: plant/validation/left_out.hpp)
//   Warned   tip twist outside -1 to 4 deg; static power or thrust in flight left over by more than 10 %; thrust that hardly
//            answers to twist (stalled at rest); no static rows; rows that blades of this shape do not give (3
//            standard deviations); a shape like none that was measured; a make of which none was
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "plant/rotor/blade_fit.hpp"

namespace whirl::plant {

struct FittedBlade {
  std::shared_ptr<const Blade> blade;
  AxialBlade axial;
  TraitBelief belief;
  double thrust_off = 0.0;  // static: sum of |error| over sum of measured
  double power_off = 0.0;
  double flight_thrust_off = 0.0;  // likewise, of the rows in flight
  double thrust_surprise = 0.0;    // of the rows to what was believed before: standard deviations
  double power_surprise = 0.0;
  double strangeness = 0.0;  // 0: like a measured one, 1: like none
  std::vector<std::string> doubts;
};

Result<FittedBlade> fit_blade(PropellerDescription description);

}  // namespace whirl::plant
