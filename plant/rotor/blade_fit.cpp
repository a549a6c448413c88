#include "plant/rotor/blade_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace whirl::plant {
namespace {

const TraitVector kStep = [] {
  TraitVector s;
  s << 0.2, 0.1, 0.02, 0.02, 0.02, 0.03, 0.03, 0.01, 0.01, 0.1, 0.02, 0.02;
  return s;
}();

struct Weighted {
  std::vector<MeasuredPoint> points;
  Eigen::VectorXd wanted, weight;  // CT, CP of each point in turn
};

Weighted weighted(const std::vector<TrustedSet>& sets) {
  Weighted all;
  std::vector<double> wanted, weight;
  for (const TrustedSet& set : sets) {
    double thrust = 0.0, power = 0.0, powers = 0.0;
    for (const MeasuredPoint& p : set.points) {
      thrust += std::abs(p.CT), power += std::abs(p.CP), powers += p.CP != 0.0 ? 1.0 : 0.0;
    }
    const auto n = static_cast<double>(set.points.size());
    const double share = std::sqrt(std::min(1.0, set.trust.independent / n));
    for (const MeasuredPoint& p : set.points) {
      all.points.push_back(p);
      wanted.insert(wanted.end(), {p.CT, p.CP});
      weight.push_back(share / (set.trust.thrust * thrust / n));
      weight.push_back(p.CP == 0.0 ? 0.0 : share / (set.trust.power * power / powers));
    }
  }
  all.wanted = Eigen::Map<Eigen::VectorXd>(wanted.data(), static_cast<Eigen::Index>(wanted.size()));
  all.weight = Eigen::Map<Eigen::VectorXd>(weight.data(), static_cast<Eigen::Index>(weight.size()));
  return all;
}

Eigen::VectorXd answers(const AxialBlade& blade, const TraitVector& traits,
                        const std::vector<MeasuredPoint>& points) {
  Eigen::VectorXd out(2 * static_cast<Eigen::Index>(points.size()));
  Eigen::Index i = 0;
  for (const MeasuredPoint& p : points) {
    const auto k = axial_coefficients(blade, traits, p.omega_radps, p.advance_ratio);
    out[i++] = k.CT;
    out[i++] = k.CP;
  }
  return out;
}

using Slopes = Eigen::Matrix<double, Eigen::Dynamic, kTraits>;

Slopes slopes(const AxialBlade& blade, const TraitVector& traits,
              const std::vector<MeasuredPoint>& points, const Eigen::VectorXd& here) {
  Slopes J(here.size(), static_cast<Eigen::Index>(kTraits));
  for (Eigen::Index k = 0; k < kTraits; ++k) {
    TraitVector moved = traits;
    moved[k] += kStep[k];
    J.col(k) = (answers(blade, moved, points) - here) / kStep[k];
  }
  return J;
}

TraitVector kept_physical(TraitVector t) {
  t[lift_maximum] = std::max(t[lift_maximum], 0.5);
  t[drag_rise] = std::max(t[drag_rise], 0.0);
  return t;
}

}  // namespace

TraitBelief fit_traits(const AxialBlade& blade, const std::vector<TrustedSet>& sets,
                       const TraitBelief& prior) {
  const Weighted data = weighted(sets);
  const TraitMatrix sure = prior.covariance.llt().solve(TraitMatrix::Identity());
  TraitVector t = prior.mean;
  Eigen::VectorXd here = answers(blade, t, data.points);
  const auto cost = [&](const TraitVector& at, const Eigen::VectorXd& there) {
    const TraitVector off = at - prior.mean;
    return (there - data.wanted).cwiseProduct(data.weight).squaredNorm() + off.dot(sure * off);
  };
  double best = cost(t, here);
  double damping = 1e-3;
  TraitMatrix H = sure;
  for (int round = 0; round < 8; ++round) {
    const Slopes J = data.weight.asDiagonal() * slopes(blade, t, data.points, here);
    const Eigen::VectorXd missing = (data.wanted - here).cwiseProduct(data.weight);
    H = J.transpose() * J + sure;
    const TraitVector pull = J.transpose() * missing - sure * (t - prior.mean);
    bool better = false;
    for (int tries = 0; tries < 6 && !better; ++tries) {
      TraitMatrix damped = H;
      damped.diagonal() *= 1.0 + damping;
      const TraitVector next = kept_physical(t + damped.llt().solve(pull));
      const Eigen::VectorXd there = answers(blade, next, data.points);
      const double c = cost(next, there);
      if (!(c < best)) {
        damping *= 6.0;
        continue;
      }
      better = best - c > 1e-3 * best;
      t = next, here = there, best = c, damping = std::max(damping / 5.0, 1e-6);
      break;
    }
    if (!better) break;
  }
  return {t, H.llt().solve(TraitMatrix::Identity()), prior.strange_make};
}

std::vector<Prediction> predict(const AxialBlade& blade, const TraitBelief& belief,
                                const std::vector<MeasuredPoint>& where) {
  const Eigen::VectorXd here = answers(blade, belief.mean, where);
  const Slopes J = slopes(blade, belief.mean, where, here);
  std::vector<Prediction> out;
  for (std::size_t i = 0; i < where.size(); ++i) {
    const auto still = axial_coefficients(blade, belief.mean, where[i].omega_radps, 0.0);
    const auto at = static_cast<Eigen::Index>(2 * i);
    const auto deviation = [&](Eigen::Index row, double own) {
      const double spread = J.row(row) * belief.covariance * J.row(row).transpose();
      return std::sqrt(spread + own * own);
    };
    const double T = belief.strange_make ? kStrange_thrust : 1.0;
    const double P = belief.strange_make ? kStrange_power : 1.0;
    out.push_back({{here[at], here[at + 1]},
                   {T * deviation(at, kThrust_off * still.CT),
                    P * deviation(at + 1, kPower_off * still.CP)}});
  }
  return out;
}

double lifting_power_deviation(const AxialBlade& blade, const TraitBelief& belief,
                               double omega_radps) {
  const std::vector<MeasuredPoint> still = {{omega_radps, 0.0, 0.0, 0.0}};
  const Eigen::VectorXd here = answers(blade, belief.mean, still);
  const Slopes J = slopes(blade, belief.mean, still, here);
  const TraitVector slope = J.row(1).transpose() / here[1] - 1.5 * J.row(0).transpose() / here[0];
  const double by_traits = slope.dot(belief.covariance * slope);
  const double own = std::hypot(kPower_off, 1.5 * kThrust_off);
  const double strange = belief.strange_make ? std::max(kStrange_thrust, kStrange_power) : 1.0;
  return strange * std::sqrt(by_traits + own * own);
}

}  // namespace whirl::plant
