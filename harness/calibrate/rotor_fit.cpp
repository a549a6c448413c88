#include "harness/calibrate/rotor_fit.hpp"

#include <cmath>
#include <numbers>

namespace whirl::calibrate {
namespace {

using regression::Problem;

Error refuse(const std::string& what, const std::string& cure) {
  return {ErrorKind::bad_input, "fit of the rotor", what, cure};
}

constexpr double kMargin = 0.95;  // the maps hold a little beyond their points

class Scale {  // to the middle speed, by the maps of still air
 public:
  Scale(const StillAirFit& still, double middle_radps) : still_(still), middle_(middle_radps) {}
  double CT(double CT, double w) const { return CT * still_.CT(middle_) / still_.CT(w); }
  double CP(double CP, double w) const { return CP * still_.CP(middle_) / still_.CP(w); }

 private:
  const StillAirFit& still_;
  double middle_;
};

RotorPoint point_of(const SteadyPoint& x, double power_W, double radius_m, const Scale& scale) {
  const double w = x.speed_radps, square = w * w;
  RotorPoint p{};
  p.wind_mps = x.wind_mps;
  p.speed_radps = w;
  p.thrust_N = x.thrust_N;
  p.CT = scale.CT(x.thrust_N / square, w);
  p.CP = scale.CP(power_W / (square * w), w);
  p.ls = x.wind_mps / (w * radius_m);
  return p;
}

Result<std::vector<RotorPoint>> points_of(const std::vector<SteadyPoint>& steady, double radius_m,
                                          const MotorFit& motor, const Scale& scale) {
  std::vector<RotorPoint> points;
  for (const SteadyPoint& x : steady) {
    points.push_back(point_of(x, motor.power_W(x), radius_m, scale));
    if (!(points.back().CP > 0.0 && points.back().CT > 0.0)) {
      return refuse("a point has no positive thrust and power", "less wind or more speed");
    }
  }
  return points;
}

// By the load cell's torque: about zero thrust the winding's current has gaps, and power is not
// what the ESC makes of it.
std::vector<RotorPoint> zero_points(const StandData& data, const Scale& scale) {
  std::vector<RotorPoint> points;
  for (const SteadyPoint& x : data.zero) {
    points.push_back(point_of(x, x.torque_Nm * x.speed_radps, data.radius_m, scale));
    points.back().CT =
        x.thrust_N / (x.speed_radps * x.speed_radps);  // not scaled: far off the maps
    points.back().CP = x.torque_Nm / (x.speed_radps * x.speed_radps);
  }
  return points;
}

// CP where CT is zero: a line through points about it.
Result<Fit> fit_zero(const std::vector<RotorPoint>& zero) {
  Problem p{
      "profile power at zero thrust", "CP", "W s3", {}, {{"c3", "W s3", {}}, {"slope", "", {}}}};
  double lowest = 1.0, highest = -1.0;
  for (const RotorPoint& x : zero) {
    p.y.push_back(x.CP);
    p.columns[0].x.push_back(1.0);
    p.columns[1].x.push_back(x.CT);
    lowest = std::min(lowest, x.thrust_N);
    highest = std::max(highest, x.thrust_N);
  }
  if (!(lowest <= 0.0 && highest >= 0.0)) {
    return refuse("no point has zero thrust between others", "more wind: see `zero` in the file");
  }
  return solve(p);
}

// CT falls with lambda from what it is in still air.
Result<Fit> fit_line(const std::vector<RotorPoint>& points, double still_CT, double still_lambda) {
  Problem p{"thrust over inflow", "loss of CT", "N s2", {}, {{"c1", "N s2", {}}}};
  for (const RotorPoint& x : points) {
    p.y.push_back(still_CT - x.CT);
    p.columns[0].x.push_back(x.li + x.ls - still_lambda);
  }
  return solve(p);
}

struct Inflow {
  double ls, li;
};

// Where the line has this thrust.
Inflow on_the_line(double CT, const RotorFit& fit) {
  const double lambda = fit.c2.value - CT / fit.c1.value;
  const double li = CT / (fit.c4 * lambda);
  return {lambda - li, li};
}

// What inflow takes of CP, times how far the speed is off the middle.
double taken_off_middle(const RotorFit& fit, const RotorPoint& x) {
  return (fit.still_CP - x.CP) * (x.speed_radps / fit.middle_radps - 1.0);
}

Result<Fit> fit_power(const RotorFit& fit) {
  constexpr double kStill_weight = 3.0;  // there thrust answers power most
  Problem p{"aerodynamic power",
            "CP - c3",
            "W s3",
            {},
            {{"c0", "m", {}}, {"c0 d0", "m", {}}, {"c0 d1", "m/CT", {}}, {"speed_effect", "", {}}}};
  for (const RotorPoint& x : fit.points) {
    const Inflow at = on_the_line(x.CT, fit);
    p.y.push_back(x.CP - fit.c3.value);
    p.columns[0].x.push_back(x.CT * at.ls);
    p.columns[1].x.push_back(x.CT * at.li);
    p.columns[2].x.push_back(x.CT * x.CT * at.li);
    p.columns[3].x.push_back(taken_off_middle(fit, x));
    p.weights.push_back(x.wind_mps > 0.0 ? 1.0 : kStill_weight);
  }
  return solve(p);
}

}  // namespace

double induced_inflow(double CT, double ls, double c4) {
  return 0.5 * (-ls + std::sqrt(ls * ls + 4.0 * CT / c4));
}

Result<RotorFit> fit_rotor(const StandData& data, const MotorFit& motor, const StillAirFit& still) {
  RotorFit fit;
  const double R = data.radius_m;
  const Range working = working_radps(data);
  fit.range_radps = {kMargin * working.low, working.high / kMargin};
  fit.middle_radps = 0.5 * (fit.range_radps.low + fit.range_radps.high);
  if (!(fit.middle_radps > 0.0)) return refuse("there are no points in wind", "see `winds`");
  const Scale scale(still, fit.middle_radps);
  fit.still_CT = still.CT(fit.middle_radps);
  fit.still_CP = still.CP(fit.middle_radps);
  const std::vector<SteadyPoint> steady = working_points(data);
  auto points = points_of(steady, R, motor, scale);
  if (!points) return points.error();
  fit.c4 = 2.0 * data.density_kgpm3 * std::numbers::pi * R * R * R * R;
  fit.points = points.value();
  for (RotorPoint& x : fit.points) x.li = induced_inflow(x.CT, x.ls, fit.c4);

  auto of_zero = fit_zero(zero_points(data, scale));
  if (!of_zero) return of_zero.error();
  fit.zero = of_zero.value();
  fit.c3 = fit.zero["c3"];

  const double still_lambda = induced_inflow(fit.still_CT, 0.0, fit.c4);
  auto of_line = fit_line(fit.points, fit.still_CT, still_lambda);
  if (!of_line) return of_line.error();
  fit.line = of_line.value();
  fit.c1 = fit.line["c1"];
  fit.c2 = {"c2", "", fit.still_CT / fit.c1.value + still_lambda, 0.0, 0.0};
  fit.c2.error = fit.still_CT * fit.c1.error / (fit.c1.value * fit.c1.value);
  fit.c2.half_width = fit.line.t95 * fit.c2.error;

  auto of_power = fit_power(fit);
  if (!of_power) return of_power.error();
  fit.power = of_power.value();
  fit.c0 = fit.power["c0"];
  fit.d0 = quotient(fit.power, "c0 d0", "c0", "d0", "");
  fit.d1 = quotient(fit.power, "c0 d1", "c0", "d1", "1/CT");
  fit.speed_effect = fit.power["speed_effect"];
  for (RotorPoint& x : fit.points) {
    x.CP -= fit.speed_effect.value * taken_off_middle(fit, x);
    const Inflow at = on_the_line(x.CT, fit);
    x.kappa = ((x.CP - fit.c3.value) / (fit.c0.value * x.CT) - at.ls) / at.li;
  }
  return fit;
}

Result<Done> physical(const RotorFit& fit, double radius_m) {
  for (const Coefficient* c : {&fit.c0, &fit.c1, &fit.c2, &fit.c3}) {
    if (auto good = physical(*c, 0.0); !good) return good;
  }
  for (const RotorPoint& x : fit.points) {
    const double kappa = fit.d0.value + fit.d1.value * x.CT;
    if (kappa > 1.0 && x.CP > x.CT * (x.li + x.ls) * radius_m) continue;
    return refuse(
        "kappa comes out as " + std::to_string(kappa) + ", below 1: less than ideal power",
        "is the current sense calibrated, are wind and radius right?");
  }
  return Done{};
}

}  // namespace whirl::calibrate
