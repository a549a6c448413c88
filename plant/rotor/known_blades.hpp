// What is believed of a blade before it is measured: the traits of measured propellers, those of
// like shape counting most.
//
//   Model   a Gaussian process over blade shapes (chord over the span, twist): covariance of two blades =
//           (1 + exp(-d^2 / 2 l^2) + 0.1 if the same) x the spread of the traits, which is learnt from the measured
//           blades in two rounds of expectation and maximisation. Tip twist is no trait of a shape but
//           an error of one drawing: -1 to 4 deg from photographs, 0.3 deg where the blade was built
//           to its drawing or scanned.
//   Source  [UiucProp]; which constants saw which propellers: plant/validation/left_out.hpp
#pragma once
#include <Eigen/Core>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"
#include "plant/rotor/blade_fit.hpp"

namespace whirl::plant {

using BladeShape = Eigen::Matrix<double, 8, 1>;
BladeShape blade_shape(const std::vector<PropellerStation>& stations);

// What its own measurements say of its traits, the prior taken out: information matrix and vector about the
// prior's mean.
struct KnownBlade {
  std::string name, make;
  bool drawn = false;  // built to a drawing or scanned: its angles are known
  BladeShape shape = BladeShape::Zero();
  TraitVector pull = TraitVector::Zero();
  TraitMatrix sure = TraitMatrix::Zero();
};

// Before any propeller was seen.
TraitBelief first_belief(bool drawn);
// From all that was measured of a propeller, at rest and in flight.
KnownBlade known_blade(const std::string& name, const std::string& make, bool drawn,
                       const std::vector<PropellerStation>& stations, const AxialBlade& blade,
                       const std::vector<TrustedSet>& sets);

class KnownBlades {
 public:
  explicit KnownBlades(std::vector<KnownBlade> blades);  // learns the spread
  KnownBlades(std::vector<KnownBlade> blades, const TraitMatrix& spread);

  TraitBelief prior_for(const BladeShape& shape, bool drawn) const;
  // 0 for a shape like those known, towards 1 for one that is like none.
  double strangeness(const BladeShape& shape) const;
  bool knows(const std::string& make) const;

  const std::vector<KnownBlade>& blades() const { return blades_; }
  const TraitMatrix& spread() const { return spread_; }

 private:
  struct Joint;  // known_blades.cpp: all of them solved at once

  std::vector<KnownBlade> blades_;
  TraitMatrix spread_;  // tip twist's row and column unused
  std::shared_ptr<const Joint> joint_;
};

// The text of plant/data/propellers/known.txt, and back.
std::string known_text(const KnownBlades& known);
Result<KnownBlades> read_known(std::string_view text, std::string_view place);

}  // namespace whirl::plant
