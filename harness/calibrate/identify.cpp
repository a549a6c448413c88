#include "harness/calibrate/identify.hpp"

#include <cmath>

namespace whirl::calibrate {
namespace {

template <typename T, typename F>
std::vector<double> column(const std::vector<T>& points, F value) {
  std::vector<double> out;
  out.reserve(points.size());
  for (const T& p : points) out.push_back(value(p));
  return out;
}

template <typename T>
std::vector<double> ones(const std::vector<T>& points) {
  return std::vector<double>(points.size(), 1.0);
}

}  // namespace

Result<Done> physical(const Coefficient& c, double low) {
  if (c.value > low) return Done{};
  return Error{ErrorKind::bad_input, "fit of " + c.name,
               std::to_string(c.value) + " " + c.unit + " is not physical",
               "look at the data's page: is the stand wired and set as the file says?"};
}

Result<SenseFit> fit_sense(const StandData& data) {
  std::vector<SteadyPoint> points = data.rest;
  points.insert(points.end(), data.still.begin(), data.still.end());
  Problem p{"current sense",
            "current told by the ESC",
            "A",
            column(points, [](const auto& x) { return x.esc_A; }),
            {{"offset", "A", ones(points)},
             {"slope", "", column(points, [](const auto& x) { return x.meter_A; })}}};
  auto fit = solve(p);
  if (!fit) return fit.error();
  SenseFit sense{inverse(fit.value(), "slope", "gain", ""), fit.value()["offset"], fit.value()};
  if (auto good = physical(sense.gain, 0.0); !good) return good.error();
  return sense;
}

Result<StillAirFit> fit_still_air(const StandData& data) {
  const auto& points = data.still;
  const auto w = column(points, [](const auto& x) { return x.speed_radps; });
  const auto w2 = column(points, [](const auto& x) { return x.speed_radps * x.speed_radps; });
  auto thrust = solve({"static thrust",
                       "thrust",
                       "N",
                       column(points, [](const auto& x) { return x.thrust_N; }),
                       {{"a2", "N s2/rad2", w2}, {"a1", "N s/rad", w}}});
  if (!thrust) return thrust.error();
  auto torque = solve({"static torque",
                       "torque",
                       "N m",
                       column(points, [](const auto& x) { return x.torque_Nm; }),
                       {{"q2", "N m s2/rad2", w2}, {"q1", "N m s/rad", w}}});
  if (!torque) return torque.error();
  StillAirFit fit{thrust.value()["a2"], thrust.value()["a1"], torque.value()["q2"],
                  torque.value()["q1"], thrust.value(),       torque.value()};
  for (const Coefficient* c : {&fit.a2, &fit.q2}) {
    if (auto good = physical(*c, 0.0); !good) return good.error();
  }
  return fit;
}

}  // namespace whirl::calibrate
