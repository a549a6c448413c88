#include "harness/inflow_bound/bound.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "plant/rotor/rotor.hpp"

namespace whirl::inflow_bound {
namespace {

constexpr int kFirst = -18, kLast = 21;  // -3.6 to 4.2 m/s
constexpr double kEvery_mps = 0.2;
constexpr double kSearched_mps = 0.01;
constexpr double kAllowed_share = 1.0 / 3.0;

// What the ESC would see at one speed and any torque, found at a few and laid between.
class SignalCurve {
 public:
  SignalCurve(const plant::MotorParams& motor, double speed_radps, double low_Nm, double high_Nm,
              double bus_V)
      : low_Nm_(low_Nm), step_Nm_(std::max((high_Nm - low_Nm) / (kPoints - 1), 1e-9)) {
    for (std::size_t i = 0; i < kPoints; ++i) {
      const double torque = low_Nm_ + static_cast<double>(i) * step_Nm_;
      points_[i] = signals_of(motor, {speed_radps, torque}, bus_V);
    }
  }
  Signals at(double torque_Nm) const {
    const double place = std::clamp((torque_Nm - low_Nm_) / step_Nm_, 0.0, kPoints - 1.0);
    const auto left = std::min(static_cast<std::size_t>(place), kPoints - 2);
    return points_[left] +
           (place - static_cast<double>(left)) * (points_[left + 1] - points_[left]);
  }

 private:
  static constexpr std::size_t kPoints = 7;
  double low_Nm_, step_Nm_;
  std::array<Signals, kPoints> points_;
};

double lowest_mps(Prior prior) {
  return prior == Prior::any ? kLow_mps : 0.0;
}

// One speed, every inflow.
struct Candidate {
  double inflow_mps = 0.0, thrust_N = 0.0;
  Signals seen;
};

std::vector<Candidate> candidates(const RotorMap& rotor, const plant::MotorParams& motor,
                                  Prior prior, double speed_radps, double bus_V) {
  std::vector<Candidate> all;
  std::vector<double> torque_Nm;
  const double from = lowest_mps(prior);
  const int count = static_cast<int>(std::lround((kHigh_mps - from) / kSearched_mps)) + 1;
  all.reserve(static_cast<std::size_t>(count)), torque_Nm.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double v = from + i * kSearched_mps;
    const auto loads = rotor.at(speed_radps, v);
    all.push_back({v, loads.thrust_N, Signals::Zero()});
    torque_Nm.push_back(loads.torque_Nm);
  }
  const auto [low, high] = std::minmax_element(torque_Nm.begin(), torque_Nm.end());
  const SignalCurve curve(motor, speed_radps, *low, *high, bus_V);
  for (std::size_t i = 0; i < all.size(); ++i) all[i].seen = curve.at(torque_Nm[i]);
  return all;
}

bool told(const Point& p) {
  return p.sigma2 <= kAllowed_share * std::abs(p.rpm_error);
}

// From the far end inwards, as long as it is told.
template <typename It>
std::optional<double> told_from(It far, It zero) {
  std::optional<double> from;
  for (; far != zero && told(*far); ++far) from = far->inflow_mps;
  return from;
}

double speed_of(const Copy& copy, double thrust_N, double inflow_mps, double top_radps) {
  const plant::Rotor rotor(copy.blade, +1);
  double low = 0.0, high = top_radps;
  for (int i = 0; i < 12; ++i) {
    plant::RotorConditions c;
    c.omega_radps = 0.5 * (low + high);
    c.v_AP_P_mps.z() = -inflow_mps;
    c.density_kgpm3 = copy.density_kgpm3;
    (rotor.steady(c).thrust_N < thrust_N ? low : high) = c.omega_radps;
  }
  return 0.5 * (low + high);
}

double top_radps(const Copy& copy, double bus_V) {
  return bus_V / copy.motor.torque_constant_NmpA;
}

}  // namespace

BoundFinder::BoundFinder(const Copy& copy, double least_N, double most_N, double top_bus_V)
    : copy_(copy),
      rotor_(copy.blade, copy.density_kgpm3,
             0.9 * speed_of(copy, least_N, 0.0, top_radps(copy, top_bus_V)),
             std::min(top_radps(copy, top_bus_V), 1.1 * speed_of(copy, most_N, kLast * kEvery_mps,
                                                                 top_radps(copy, top_bus_V)))) {}

Point BoundFinder::point(const Doubts& doubts, Prior prior, double thrust_N, double inflow_mps,
                         double bus_V) const {
  Point p{.inflow_mps = inflow_mps, .low_mps = inflow_mps, .high_mps = inflow_mps};
  p.speed_radps = rotor_.speed_for(thrust_N, inflow_mps);
  p.rpm_error = rotor_.at(rotor_.speed_for(thrust_N, 0.0), inflow_mps).thrust_N / thrust_N - 1.0;
  const auto all = candidates(rotor_, copy_.motor, prior, p.speed_radps, bus_V);
  const auto true_loads = rotor_.at(p.speed_radps, inflow_mps);
  const Shaft shaft{p.speed_radps, true_loads.torque_Nm};
  const Eigen::Matrix2d weight =
      covariance(copy_.motor, copy_.shunt, doubts, shaft, bus_V).inverse();
  const auto& truth = *std::min_element(all.begin(), all.end(), [&](const auto& a, const auto& b) {
    return std::abs(a.inflow_mps - inflow_mps) < std::abs(b.inflow_mps - inflow_mps);
  });
  for (const Candidate& c : all) {
    const Signals off = c.seen - truth.seen;
    const double distance2 = off.dot(weight * off);
    const double error = std::abs(c.thrust_N - truth.thrust_N) / thrust_N;
    if (distance2 <= 4.0) p.sigma2 = std::max(p.sigma2, error);
    if (distance2 > 1.0) continue;
    p.sigma = std::max(p.sigma, error);
    p.low_mps = std::min(p.low_mps, c.inflow_mps), p.high_mps = std::max(p.high_mps, c.inflow_mps);
  }
  return p;
}

Bound BoundFinder::at(const Doubts& doubts, Prior prior, double thrust_N, double bus_V) const {
  Bound bound{thrust_N, bus_V, {}, {}, {}};
  const int first = prior == Prior::any ? kFirst : 0;
  bound.points.reserve(kLast - kFirst + 1);
  for (int i = first; i <= kLast; ++i) {
    bound.points.push_back(point(doubts, prior, thrust_N, i * kEvery_mps, bus_V));
  }
  const auto zero = std::find_if(bound.points.begin(), bound.points.end(),
                                 [](const Point& p) { return p.inflow_mps > 0.5 * kEvery_mps; });
  bound.told_from_mps = told_from(bound.points.rbegin(), std::make_reverse_iterator(zero));
  bound.told_from_below_mps = told_from(bound.points.begin(), zero);
  return bound;
}

}  // namespace whirl::inflow_bound
