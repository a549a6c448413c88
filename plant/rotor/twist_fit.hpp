// A propeller's tip twist from its static thrust alone, where its sections are named (else: fitted_blade.hpp).
//
//   Why    blade angles read off photographs are a few degrees low outboard; one number, added in
//          proportion to r/R, puts the mean static thrust right and leaves torque and forward flight
//          to be foretold.
//   Refused  static thrust that no correction from -3 to 6 deg meets
//   Warned   a correction outside -1 to 4 deg, found or given; thrust that hardly answers to twist (stalled at rest);
//            static power left over by more than 10 %: the same as of a fitted blade (fitted_blade.hpp)
//   Band     none but by the stated error of computed sections' drag: the blade with that much less and more
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "plant/rotor/blade.hpp"

namespace whirl::plant {

// The smallest correction that meets the summed thrust coefficient; description.tip_twist_correction_rad is ignored.
Result<double> fit_tip_twist_rad(PropellerDescription description,
                                 const std::vector<StaticPoint>& points);

// Where a blade is believed, of any fit.
inline constexpr double kLowest_twist_deg = -1.0;  // of angles read off photographs
inline constexpr double kHighest_twist_deg = 4.0;
inline constexpr double kRefused_beyond_deg = 2.0;
inline constexpr double kMost_left = 0.10;  // of static thrust or power
// Of thrust, per degree of tip twist; healthy blades: 0.03 to 0.06.
inline constexpr double kLeast_answer = 0.01;
std::string twist_doubt(double twist_deg);  // empty: none
std::string answer_doubt(double share_per_deg);
std::string power_doubt(double share_left);

struct TwistedBlade {
  std::shared_ptr<const Blade> blade;
  double tip_twist_rad = 0.0;
  bool found = false;                        // on static rows; else as the file gives it
  double thrust_off = 0.0, power_off = 0.0;  // static: sum of |error| over sum of measured
  double answer_per_deg = 0.0;               // of static thrust, a share
  double drag_within = 0.0;                  // the largest that a section states
  PropellerDescription description;          // with that twist
  std::vector<std::string> doubts;
};
// The blade of a description; where it brings static points, with the twist that they ask for.
Result<TwistedBlade> make_fitted_blade(PropellerDescription description);
// The same with the drag of each section off by what it states. side: -1 less, +1 more.
std::shared_ptr<const Blade> with_section_drag(const TwistedBlade& made, int side);

struct PropellerCoefficients {
  double CT = 0.0;  // T / (rho n^2 D^4)
  double CP = 0.0;  // P / (rho n^3 D^5)
};
// Steady, along the shaft, at sea level; J = V / (n D).
PropellerCoefficients propeller_coefficients(const std::shared_ptr<const Blade>& blade,
                                             double omega_radps, double advance_ratio);

}  // namespace whirl::plant
