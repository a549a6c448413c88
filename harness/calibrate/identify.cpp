#include "harness/calibrate/identify.hpp"

#include <algorithm>
#include <cmath>

namespace whirl::calibrate {
namespace {

using regression::Column;
using regression::Problem;

template <typename T>
std::vector<double> ones(const std::vector<T>& points) {
  return std::vector<double>(points.size(), 1.0);
}

}  // namespace

Range working_radps(const StandData& data) {
  const auto slower = [](const SteadyPoint& a, const SteadyPoint& b) {
    return a.speed_radps < b.speed_radps;
  };
  if (data.blown.empty()) return {};
  const auto [low, high] = std::minmax_element(data.blown.begin(), data.blown.end(), slower);
  return {0.95 * low->speed_radps, 1.05 * high->speed_radps};
}

std::vector<SteadyPoint> working_still(const StandData& data) {
  const Range working = working_radps(data);
  std::vector<SteadyPoint> points;
  for (const SteadyPoint& x : data.still) {
    if (working.holds(x.speed_radps)) points.push_back(x);
  }
  return points;
}

std::vector<SteadyPoint> working_points(const StandData& data) {
  std::vector<SteadyPoint> points = working_still(data);
  points.insert(points.end(), data.blown.begin(), data.blown.end());
  return points;
}

Result<Done> physical(const Coefficient& c, double low) {
  if (c.value > low) return Done{};
  return Error{ErrorKind::bad_input, "fit of " + c.name,
               std::to_string(c.value) + " " + c.unit + " is not physical",
               "look at the data's page: is the stand wired and set as the file says?"};
}

// A line with an intercept: while the PWM runs, sampling in step with a rippling current leaves a
// constant (the ripple hardly moves with duty) that the zero found at rest does not hold. Points in
// still air only, which follow the zero at once: what the offset wanders by later is no constant.
Result<SenseFit> fit_sense(const StandData& data) {
  Problem p{"current sense",
            "current told by the ESC",
            "A",
            column(data.still, [](const auto& x) { return x.esc_A; }),
            {{"slope", "", column(data.still, [](const auto& x) { return x.meter_A; })},
             {"offset", "A", ones(data.still)}}};
  p.weights = column(data.still, [](const auto& x) { return 1.0 / x.meter_A; });
  auto fit = solve(p);
  if (!fit) return fit.error();
  return SenseFit{inverse(fit.value(), "slope", "gain", ""), fit.value()["offset"], fit.value()};
}

// Errors count as shares, those outside the working speeds a tenth.
Problem map_problem(const StandData& data, const std::string& name, const std::string& unit,
                    std::vector<Column> columns, const std::vector<int>& powers,
                    const std::vector<double>& y) {
  Problem p{name, name, unit, y, std::move(columns)};
  const Range working = working_radps(data);
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double w = data.still[i].speed_radps;
    for (std::size_t k = 0; k < powers.size(); ++k) {
      p.columns[k].x.push_back(std::pow(w, powers[k]));
    }
    p.weights.push_back((working.holds(w) ? 1.0 : 0.1) / y[i]);
  }
  return p;
}

Result<StillAirFit> fit_still_air(const StandData& data, const MotorFit& motor) {
  const auto thrust_N = column(data.still, [](const auto& x) { return x.thrust_N; });
  // By the ESC's own power balance where that holds, by the load cell elsewhere.
  const Range working = working_radps(data);
  const auto torque_Nm = column(data.still, [&](const auto& x) {
    return working.holds(x.speed_radps) ? motor.power_W(x) / x.speed_radps : x.torque_Nm;
  });
  auto thrust =
      solve(map_problem(data, "static thrust", "N",
                        {{"a2", "N s2/rad2", {}}, {"a1", "N s/rad", {}}, {"a3", "N s3/rad3", {}}},
                        {2, 1, 3}, thrust_N));
  if (!thrust) return thrust.error();
  auto torque = solve(
      map_problem(data, "static torque", "N m",
                  {{"q2", "N m s2/rad2", {}}, {"q3", "N m s3/rad3", {}}, {"q4", "N m s4/rad4", {}}},
                  {2, 3, 4}, torque_Nm));
  if (!torque) return torque.error();
  StillAirFit fit;
  fit.thrust = thrust.value();
  fit.torque = torque.value();
  fit.a = fit.thrust.coefficients;
  fit.q = fit.torque.coefficients;
  for (const SteadyPoint& x : data.updraft) {
    const double w = x.speed_radps;
    const double share = motor.power_W(x) / (w * w * w * fit.CP(w));
    if (fit.updraft_share == 0.0 || share < fit.updraft_share) fit.updraft_share = share;
  }
  return fit;
}

double StillAirFit::CT(double w) const {
  return a[0].value + a[1].value / w + a[2].value * w;
}

double StillAirFit::CP(double w) const {
  return q[0].value + q[1].value * w + q[2].value * w * w;
}

}  // namespace whirl::calibrate
