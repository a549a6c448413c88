#include "harness/inflow_bound/bound.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "base/near.hpp"
#include "base/random.hpp"
#include "harness/catalogue/propeller_file.hpp"
#include "plant/rotor/rotor.hpp"

namespace whirl::inflow_bound {
namespace {

const Copy& stock() {
  static const Copy copy = [] {
    const auto read =
        catalogue::read_propeller(std::string(WHIRL_ROOT) + "/test_plans/propellers/hk_10x4.5.lua");
    EXPECT_TRUE(read.ok());
    return Copy{read.value(), {}, {}, 1.225};
  }();
  return copy;
}

const BoundFinder& finder() {
  static const BoundFinder found(stock(), 2.4, 4.0, 16.8);
  return found;
}

TEST(RotorMap, IsTheRotorBetweenItsPoints) {
  const plant::Rotor rotor(stock().blade, +1);
  for (const double w : {430.0, 515.0}) {
    for (const double v : {-2.9, 0.35, 2.1, 3.9}) {
      plant::RotorConditions c;
      c.omega_radps = w;
      c.v_AP_P_mps.z() = -v;
      const plant::RotorLoads want = rotor.steady(c);
      const auto got = finder().rotor().at(w, v);
      EXPECT_TRUE(near(got.thrust_N, want.thrust_N,
                       stated(2e-3 * want.thrust_N, "straight between points of 0.2 m/s")))
          << w << " " << v;
      EXPECT_TRUE(near(got.torque_Nm, want.shaft_torque_Nm,
                       stated(2e-3 * want.shaft_torque_Nm, "straight between points of 0.2 m/s")))
          << w << " " << v;
    }
  }
}

// i = Q/Kt + I0; V = Ke w + (R + what commutation looks like) i + what the diodes take; the bus carries the
// duty's share of i.
TEST(DriveSignals, AreTheMotorsOwnEquations) {
  const plant::MotorParams m;
  const Shaft shaft{500.0, 0.06};
  const Signals s = signals_of(m, shaft, 16.0);
  const double i_A = shaft.torque_Nm / m.torque_constant_NmpA + m.no_load_current_A;
  const double looks_ohm =
      m.resistance_ohm + 3.0 / std::numbers::pi * m.pole_pairs * 500.0 * m.inductance_H / 2.0;
  const double duty = s.y() / 16.0;
  const double want_V =
      m.torque_constant_NmpA * 500.0 + looks_ohm * i_A + (1.0 - duty) * m.diode_drop_V;
  EXPECT_TRUE(near(s.y(), want_V, stated(0.03 * want_V, "commutation's dips are no resistance")));
  EXPECT_TRUE(near(s.x(), i_A * duty, stated(0.03 * i_A * duty, "what commutations hand back")));
}

// The propeller of the vehicle, cold and calibrated, on a full pack: what the thesis's table 5.6 shows.
TEST(InflowBound, StrongDowndraftsAreToldAndGentleOnesAreNot) {
  const Bound any = finder().at(as_calibrated(), Prior::any, 3.2, 16.4);
  ASSERT_TRUE(any.told_from_mps);
  EXPECT_LE(*any.told_from_mps, 3.5);
  EXPECT_GT(*any.told_from_mps, 1.0);
  EXPECT_FALSE(any.told_from_below_mps) << "updrafts raise thrust by less than they can be told";
  const Bound above = finder().at(as_calibrated(), Prior::from_above, 3.2, 16.4);
  ASSERT_TRUE(above.told_from_mps);
  EXPECT_LT(*above.told_from_mps, *any.told_from_mps) << "no updraft to take it for";
}

TEST(InflowBound, DoubtsAndNothingElseRaiseIt) {
  for (const double inflow : {2.2, 3.6}) {
    const Point cold = finder().point(as_calibrated(), Prior::from_above, 3.2, inflow, 16.4);
    const Point later = finder().point(another_day(), Prior::from_above, 3.2, inflow, 16.4);
    EXPECT_GT(later.sigma, 1.5 * cold.sigma);
    EXPECT_GE(cold.sigma2, cold.sigma);
    EXPECT_EQ(later.rpm_error, cold.rpm_error);
  }
}

// A copy of the ESC's instruments, run as a stand would: power-up, zero at rest, thrust, one reading.
Signals reading(const Signals& truth, const Doubts& d, std::uint64_t seed) {
  plant::CurrentShuntParams params = stock().shunt;
  params.gain_tolerance = 0.0;  // calibrated
  plant::CurrentShunt shunt(params, seed);
  const auto mean_A = [&](double bus_A, double time_s) {
    const int count = static_cast<int>(std::lround(time_s * d.sample_rate_Hz));
    double sum = 0.0;
    for (int i = 0; i < count; ++i) {
      shunt.flow(bus_A, 1.0 / d.sample_rate_Hz);
      sum += shunt.sample_A();
    }
    return sum / count;
  };
  const auto wait = [&](double bus_A, double time_s) {
    for (double t = 0.0; t < time_s; t += 0.5) shunt.flow(bus_A, 0.5);
  };
  wait(0.0, d.powered_s);
  const double zero_A = mean_A(0.0, d.zero_taken_s);
  wait(truth.x(), d.since_zero_s - 0.5 * d.averaged_s);
  RandomStream meter(seed, "voltmeter");
  const double step = d.step_V * std::sqrt(12.0) * (meter.uniform() - 0.5);
  return {mean_A(truth.x(), d.averaged_s) - zero_A, truth.y() + step};
}

struct
    Fit {  // the best that can be had: every inflow tried, weighed by the scatter that the copies show
  std::vector<double> thrust_N;
  std::vector<Signals> seen;
  double best_N(const Signals& reading, const Eigen::Matrix2d& weight) const {
    double least = 1e300, thrust = 0.0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const Signals off = reading - seen[i];
      const double distance = off.dot(weight * off);
      if (distance < least) least = distance, thrust = thrust_N[i];
    }
    return thrust;
  }
};

Fit fit_at(double speed_radps, double bus_V) {
  Fit fit;
  for (double v = 0.0; v <= kHigh_mps; v += 0.02) {
    const auto loads = finder().rotor().at(speed_radps, v);
    fit.thrust_N.push_back(loads.thrust_N);
    fit.seen.push_back(signals_of({}, {speed_radps, loads.torque_Nm}, bus_V));
  }
  return fit;
}

struct Scatter {
  double rms = 0.0;  // of thrust, relative
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

Scatter scatter_of(const Doubts& doubts, double thrust_N, double inflow_mps, double bus_V) {
  constexpr int kCopies = 150;
  const double w = finder().rotor().speed_for(thrust_N, inflow_mps);
  const Signals truth = signals_of({}, {w, finder().rotor().at(w, inflow_mps).torque_Nm}, bus_V);
  std::vector<Signals> readings;
  Scatter s;
  for (int i = 0; i < kCopies; ++i) {
    readings.push_back(reading(truth, doubts, 1000 + static_cast<std::uint64_t>(i)));
    const Signals off = readings.back() - truth;
    s.covariance += off * off.transpose() / kCopies;
  }
  const Fit fit = fit_at(w, bus_V);
  double sum = 0.0;
  for (const Signals& r : readings) {
    sum += std::pow(fit.best_N(r, s.covariance.inverse()) / thrust_N - 1.0, 2);
  }
  s.rms = std::sqrt(sum / kCopies);
  return s;
}

// The other side: no fit to what such instruments really show beats the bound by more than half, and the
// bound is not so low that none comes near it.
TEST(InflowBound, IsWhatTheBestFitToTheInstrumentsReaches) {
  for (const double inflow : {1.6, 2.8, 4.0}) {
    const Scatter s = scatter_of(as_calibrated(), 3.2, inflow, 16.4);
    const Point p = finder().point(as_calibrated(), Prior::from_above, 3.2, inflow, 16.4);
    EXPECT_GT(s.rms, p.sigma / 1.5) << inflow << ": bound " << p.sigma;
    EXPECT_LT(s.rms, p.sigma * 1.5) << inflow << ": bound " << p.sigma;
  }
}

TEST(DriveSignals, ScatterOfTheCurrentIsThatOfTheInstruments) {
  const Scatter s = scatter_of(as_calibrated(), 3.2, 4.0, 16.4);
  const double w = finder().rotor().speed_for(3.2, 4.0);
  const Signals truth = signals_of({}, {w, finder().rotor().at(w, 4.0).torque_Nm}, 16.4);
  const double want = current_sigma_A(stock().shunt, as_calibrated(), truth.x());
  EXPECT_TRUE(near(std::sqrt(s.covariance(0, 0)), want,
                   stated(0.18 * want, "three sigma of a sigma from 150 copies")));
}

}  // namespace
}  // namespace whirl::inflow_bound
