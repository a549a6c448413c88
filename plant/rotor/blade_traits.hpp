// What drawings do not say of a bought blade: a section in eleven numbers and the errors of its angles.
//
//   What    lift: a straight line that steps down by a share below an angle and bends into its maximum; drag:
//           a bucket, and separated flow in proportion to the lift that is missing. Slope, maximum, least
//           drag and the step's place go with the Reynolds number. Beyond 20 deg all fades into a flat
//           plate, reached at 45 deg.
//   Units   angles of this file in degrees, as a protractor reads them; Reynolds numbers over 60,000.
//   Valid   as a description of a whole blade at Re 1e4 to 2e5; traits make up for one another, so one
//           of them alone is no measurement of the section.
//   Source  stall delay: [Snel]; where the step lies: docs/unseen_propellers.md; the rest is fitted:
//           blade_fit.hpp, known_blades.hpp
#pragma once
#include <Eigen/Core>
#include <array>
#include <string_view>

#include "plant/rotor/polar.hpp"

namespace whirl::plant {

enum Trait {
  tip_twist_deg,    // added in proportion to r/R: angles read off photographs are low outboard
  zero_lift_deg,    // of the section against the given chord line
  ln_lift_slope,    // per radian
  slope_power,      // of the Reynolds number
  lift_maximum,     // without rotation's help
  ln_least_drag,    //
  drag_power,       // least drag falls as Re^-this
  drag_rise,        // times (cl - 0.5)^2
  hover_loss,       // induced factor, ring_balance.hpp
  speed_twist_deg,  // more tip twist at n D = 20 m/s, with the square of the speed
  maximum_power,    // of the lift maximum
  lift_step,        // share of lift that is missing below the step
  kTraits
};
inline constexpr std::array<std::string_view, kTraits> kTrait_names = {
    "tip twist / deg", "zero lift / deg",      "ln lift slope",        "slope, power of Re",
    "lift maximum",    "ln least drag",        "drag, power of Re",    "drag rise",
    "hover loss",      "twist by speed / deg", "maximum, power of Re", "lift step"};

using TraitVector = Eigen::Matrix<double, kTraits, 1>;
using TraitMatrix = Eigen::Matrix<double, kTraits, kTraits>;

// The traits of one ring at one Reynolds number, ready for many angles.
struct TraitSection {
  double slope_per_rad = 0.0;
  double zero_lift_rad = 0.0;
  double maximum = 0.0;
  double step = 0.0;     // share of lift
  double step_at = 0.0;  // straight line's lift in the middle of the step
  double least_drag = 0.0;
  double rise = 0.0;
  double delay = 0.0;  // share of the missing lift that rotation brings back
};
TraitSection trait_section(const TraitVector& traits, double chord_over_r, double reynolds);
SectionCoefficients coefficients(const TraitSection& section, double alpha_rad);
double stall_angle_rad(const TraitSection& section);

// Tip twist of the blade at a speed; n D in m/s.
double tip_twist_rad(const TraitVector& traits, double nD_mps);
inline constexpr double kTwist_speed_mps = 20.0;

}  // namespace whirl::plant
