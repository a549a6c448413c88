// Which inflow an ESC can tell from current, voltage and speed, and how wrong the thrust must be that it
// concludes from them: a floor under every estimator, computed from the parts' stated errors.
//
//   Frame    inflow_mps positive: air from above (as in a climb); thrust in N, errors relative to the thrust
//            asked for
//   Method   At the speed at which the propeller lifts the thrust in that inflow, each other inflow would show
//            other signals. What lies within one sigma (Mahalanobis distance of the signals' covariance) cannot
//            be told from the truth, wherever on the curve it lies: power may rise, stand still and fall over
//            inflow, which a slope at one point (Cramer-Rao) does not see. The thrust of the farthest such
//            inflow against the true one is the error that must be expected (`sigma`); `sigma2` is that of two.
//   Prior    where the air may come from. A propeller takes as much power in one updraft as in some downdraft: who
//            may be in either cannot tell them apart, and believes up to a fifth of the thrust wrongly
//   Told     from this inflow on (towards stronger ones, to the end of the range) two sigma stay below a third of
//            what the static map (RPM control) loses
//   Valid    steady speed and inflow, one reading of averaged_s; the propeller's and the motor's curves known
//            exactly but for what Doubts names; inflow within the prior, of which
//            nothing is preferred
//   Left out what steps of speed add (the same inflow at two speeds), what other ESCs of a vehicle see,
//            ripple; the error of the curves themselves, which is the calibration's
//   Error    against the best fit to signals of the plant's own motor and current sense over 150 copies:
//            tests/bound_test.cpp
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "harness/inflow_bound/drive_signals.hpp"
#include "harness/inflow_bound/rotor_map.hpp"
#include "plant/rotor/blade.hpp"

namespace whirl::inflow_bound {

struct Copy {  // of the hardware, as it is believed to be
  std::shared_ptr<const plant::Blade> blade;
  plant::MotorParams motor;
  plant::CurrentShuntParams shunt;
  double density_kgpm3 = 1.225;
};

enum class Prior { any, from_above };

struct Point {
  double inflow_mps = 0.0, speed_radps = 0.0;
  double rpm_error = 0.0;  // of the static map at its own speed: what inflow does to thrust
  double sigma = 0.0, sigma2 = 0.0;      // that cannot be avoided
  double low_mps = 0.0, high_mps = 0.0;  // the inflows within one sigma
};

struct Bound {
  double thrust_N = 0.0, bus_V = 0.0;
  std::vector<Point> points;                  // over inflow, -3.6 (or 0) to 4.2 m/s by 0.2
  std::optional<double> told_from_mps;        // air from above
  std::optional<double> told_from_below_mps;  // and from below (negative)
};

class BoundFinder {
 public:
  // For thrusts up to most_N in still air.
  BoundFinder(const Copy& copy, double least_N, double most_N, double top_bus_V);
  Bound at(const Doubts& doubts, Prior prior, double thrust_N, double bus_V) const;
  Point point(const Doubts& doubts, Prior prior, double thrust_N, double inflow_mps,
              double bus_V) const;
  const RotorMap& rotor() const { return rotor_; }

 private:
  Copy copy_;
  RotorMap rotor_;
};

}  // namespace whirl::inflow_bound
