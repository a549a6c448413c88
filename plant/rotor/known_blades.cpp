#include "plant/rotor/known_blades.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/angles.hpp"

namespace whirl::plant {
namespace {

constexpr double kCommon = 1.0;
constexpr double kOwn = 0.1;
constexpr double kLength = 2.5;
constexpr Eigen::Index kShaped = kTraits - 1;  // all but the tip twist, which comes first

using Dense = Eigen::MatrixXd;
using Shaped = Eigen::Matrix<double, kShaped, kShaped>;

double likeness(const BladeShape& a, const BladeShape& b) {
  return kCommon + std::exp(-0.5 * (a - b).squaredNorm() / (kLength * kLength));
}

Dense inverse(const Dense& positive) {
  return positive.llt().solve(Dense::Identity(positive.rows(), positive.cols()));
}

// All known blades at once: the normal equations of their traits.
struct Equations {
  Dense likeness_inverse;
  Dense matrix;
  Eigen::VectorXd pull;
};

Equations equations(const std::vector<KnownBlade>& blades, const Shaped& spread) {
  const auto n = static_cast<Eigen::Index>(blades.size());
  Dense K(n, n);
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index b = 0; b < n; ++b) {
      K(a, b) = likeness(blades[static_cast<std::size_t>(a)].shape,
                         blades[static_cast<std::size_t>(b)].shape) +
                (a == b ? kOwn : 0.0);
    }
  }
  const Shaped sure = inverse(spread);
  Equations e{inverse(K), Dense::Zero(n * kTraits, n * kTraits), Eigen::VectorXd(n * kTraits)};
  for (Eigen::Index a = 0; a < n; ++a) {
    const KnownBlade& blade = blades[static_cast<std::size_t>(a)];
    for (Eigen::Index b = 0; b < n; ++b) {
      e.matrix.block(a * kTraits + 1, b * kTraits + 1, kShaped, kShaped) =
          e.likeness_inverse(a, b) * sure;
    }
    e.matrix.block(a * kTraits, a * kTraits, kTraits, kTraits) += blade.sure;
    e.matrix(a * kTraits, a * kTraits) += 1.0 / first_belief(blade.drawn).covariance(0, 0);
    e.pull.segment(a * kTraits, kTraits) = blade.pull;
  }
  return e;
}

Shaped learnt_spread(const std::vector<KnownBlade>& blades) {
  const Shaped first = first_belief(false).covariance.block<kShaped, kShaped>(1, 1);
  constexpr double kWeight_of_first = 6.0;  // as many blades
  const auto n = static_cast<Eigen::Index>(blades.size());
  Shaped spread = 0.5 * first;
  for (int round = 0; round < 2; ++round) {
    const Equations e = equations(blades, spread);
    const Dense covariance = inverse(e.matrix);
    const Eigen::VectorXd mean = covariance * e.pull;
    Shaped sum = Shaped::Zero();
    for (Eigen::Index a = 0; a < n; ++a) {
      for (Eigen::Index b = 0; b < n; ++b) {
        const auto x = mean.segment<kShaped>(a * kTraits + 1);
        const auto y = mean.segment<kShaped>(b * kTraits + 1);
        sum +=
            e.likeness_inverse(a, b) * (x * y.transpose() + covariance.block<kShaped, kShaped>(
                                                                a * kTraits + 1, b * kTraits + 1));
      }
    }
    spread = (0.5 * (sum + sum.transpose()) + kWeight_of_first * 0.3 * first) /
             (static_cast<double>(n) + kWeight_of_first);
  }
  return spread;
}

TraitMatrix whole(const Shaped& spread) {
  TraitMatrix m = TraitMatrix::Zero();
  m.block<kShaped, kShaped>(1, 1) = spread;
  return m;
}

Eigen::VectorXd likenesses(const std::vector<KnownBlade>& blades, const BladeShape& shape) {
  Eigen::VectorXd k(static_cast<Eigen::Index>(blades.size()));
  for (Eigen::Index a = 0; a < k.size(); ++a) {
    k[a] = likeness(blades[static_cast<std::size_t>(a)].shape, shape);
  }
  return k;
}

}  // namespace

BladeShape blade_shape(const std::vector<PropellerStation>& rows) {
  const auto at = [&](double x, double PropellerStation::*field) {
    return station_value(rows, x, field);
  };
  const double chord = at(0.75, &PropellerStation::c_over_R);
  const double angle = at(0.75, &PropellerStation::angle_rad);
  const auto c = [&](double x) { return at(x, &PropellerStation::c_over_R) / chord; };
  const auto beta_deg = [&](double x) { return at(x, &PropellerStation::angle_rad) / kDeg; };
  const double a = angle / kDeg;
  BladeShape s;
  // Each over about its spread among slow flyers, sport and electric propellers; a helix would have the
  // last two the same for every pitch.
  s << chord / 0.03, c(0.2) / 0.3, c(0.4) / 0.2, c(0.6) / 0.1, c(0.9) / 0.1, c(1.0) / 0.2,
      (beta_deg(0.35) - 1.9 * a) / 6.0, (beta_deg(0.95) - 0.8 * a) / 2.0;
  return s;
}

TraitBelief first_belief(bool drawn) {
  TraitBelief b;
  b.mean << (drawn ? 0.0 : 1.5), -2.0, std::log(6.5), 0.17, 1.2, -3.5, 0.6, 0.05, 1.12, 0.0, 0.1,
      0.1;
  TraitVector d;
  d << (drawn ? 0.3 : 1.0), 2.0, 0.1, 0.12, 0.2, 0.3, 0.2, 0.04, 0.04, 0.5, 0.15, 0.1;
  b.covariance = d.cwiseProduct(d).asDiagonal();
  return b;
}

KnownBlade known_blade(const std::string& name, const std::string& make, bool drawn,
                       const std::vector<PropellerStation>& stations, const AxialBlade& blade,
                       const std::vector<TrustedSet>& sets) {
  const TraitBelief first = first_belief(drawn);
  const TraitBelief fit = fit_traits(blade, sets, first);
  const TraitMatrix all = fit.covariance.llt().solve(TraitMatrix::Identity());
  const TraitMatrix before = first.covariance.llt().solve(TraitMatrix::Identity());
  KnownBlade known{name, make, drawn, blade_shape(stations), {}, {}};
  known.sure = all - before;
  known.pull = all * (fit.mean - first.mean);
  return known;
}

struct KnownBlades::Joint {
  Dense likeness_inverse;
  Eigen::LLT<Dense> solver;
  Eigen::VectorXd mean;
};

KnownBlades::KnownBlades(std::vector<KnownBlade> blades)
    : KnownBlades(blades, whole(learnt_spread(blades))) {}

KnownBlades::KnownBlades(std::vector<KnownBlade> blades, const TraitMatrix& spread)
    : blades_(std::move(blades)), spread_(spread) {
  Equations e = equations(blades_, spread_.block<kShaped, kShaped>(1, 1));
  Joint joint{std::move(e.likeness_inverse), e.matrix.llt(), {}};
  joint.mean = joint.solver.solve(e.pull);
  joint_ = std::make_shared<const Joint>(std::move(joint));
}

TraitBelief KnownBlades::prior_for(const BladeShape& shape, bool drawn) const {
  const Shaped spread = spread_.block<kShaped, kShaped>(1, 1);
  const Eigen::VectorXd k = likenesses(blades_, shape);
  const Eigen::VectorXd w = joint_->likeness_inverse * k;
  Eigen::Matrix<double, kShaped, 1> mean = Eigen::Matrix<double, kShaped, 1>::Zero();
  Dense share = Dense::Zero(w.size() * kTraits, kShaped);
  for (Eigen::Index a = 0; a < w.size(); ++a) {
    mean += w[a] * joint_->mean.segment<kShaped>(a * kTraits + 1);
    share.block<kShaped, kShaped>(a * kTraits + 1, 0).diagonal().setConstant(w[a]);
  }
  const Shaped covariance = (kCommon + 1.0 + kOwn - k.dot(w)) * spread +
                            Shaped(share.transpose() * joint_->solver.solve(share));
  TraitBelief prior = first_belief(drawn);
  prior.mean.tail<kShaped>() += mean;
  prior.covariance.block<kShaped, kShaped>(1, 1) = 0.5 * (covariance + covariance.transpose());
  return prior;
}

double KnownBlades::strangeness(const BladeShape& shape) const {
  double most = 0.0;
  for (const KnownBlade& b : blades_) most = std::max(most, likeness(b.shape, shape) - kCommon);
  return 1.0 - most;
}

bool KnownBlades::knows(const std::string& make) const {
  return std::any_of(blades_.begin(), blades_.end(),
                     [&](const KnownBlade& b) { return b.make == make; });
}

}  // namespace whirl::plant
