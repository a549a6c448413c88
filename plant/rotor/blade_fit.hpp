// The traits of one blade from measured points: the most likely ones and how sure they are.
//
//   Model   Gaussian prior (known_blades.hpp) times Gaussian errors; Gauss-Newton with damping from the prior's
//           mean, so the answer is one and the same on every run.
//   Errors  points of one propeller err together: a set counts as a few independent points however many it has.
//   Out     mean and covariance; predict() turns them into a curve with its standard deviation, to which
//           the model's own discrepancy is added (kThrust_off, kPower_off, set by leaving propellers out).
#pragma once
#include <vector>

#include "plant/rotor/axial_flow.hpp"

namespace whirl::plant {

struct TraitBelief {
  TraitVector mean = TraitVector::Zero();
  TraitMatrix covariance = TraitMatrix::Zero();
  bool strange_make = false;  // none of its make was measured: predict() widens its deviation
};

struct MeasuredPoint {
  double omega_radps = 0.0;
  double advance_ratio = 0.0;
  double CT = 0.0;
  double CP = 0.0;  // 0: was not measured
};

// What a set of points is trusted with: relative error against its mean, and how many count.
struct Trust {
  double thrust = 0.0;
  double power = 0.0;
  double independent = 0.0;
};
inline constexpr Trust kStatic_trust{0.015, 0.03, 4.0};
inline constexpr Trust kFlight_trust{0.03, 0.04, 8.0};

struct TrustedSet {
  std::vector<MeasuredPoint> points;
  Trust trust;
};

TraitBelief fit_traits(const AxialBlade& blade, const std::vector<TrustedSet>& sets,
                       const TraitBelief& prior);

// Of static CT and CP at the same speed, one standard deviation.
inline constexpr double kThrust_off = 0.033;
inline constexpr double kPower_off = 0.041;
// Times the deviation for a make of which nobody measured one: what brought nine in ten points of a make that
// was left out into its band when 32 were known (1.44 and 1.34; of 44, 92 % are inside). With each make's factor
// from the other five makes alone it held 87 and 88 % of its points: so much of a stranger's.
inline constexpr double kStrange_thrust = 1.45;
inline constexpr double kStrange_power = 1.35;
inline constexpr double kNine_in_ten = 1.645;  // standard deviations

struct Prediction {
  PropellerCoefficients mean;
  PropellerCoefficients deviation;  // one standard deviation
};
std::vector<Prediction> predict(const AxialBlade& blade, const TraitBelief& belief,
                                const std::vector<MeasuredPoint>& where);

// Of the shaft power that lifts a given thrust at rest, CP / CT^(3/2): one standard deviation over its mean. What the
// traits do to both is counted together; the discrepancies of CT and CP are taken as independent.
double lifting_power_deviation(const AxialBlade& blade, const TraitBelief& belief,
                               double omega_radps);

}  // namespace whirl::plant
