#include <cmath>

#include "base/rpm.hpp"
#include "harness/calibrate/report.hpp"

namespace whirl::calibrate {
namespace {

using results::Chart;
using results::ChartCurve;
using results::ChartFigure;

std::vector<ChartFigure> figures(const Fit& fit, const std::vector<Coefficient>& rows) {
  std::vector<ChartFigure> out;
  const double reported = std::numeric_limits<double>::infinity();
  for (const Coefficient& c : rows) {
    out.push_back({c.name, c.value, reported, c.unit, true});
    out.push_back({c.name + ", 95 % interval, +-", c.half_width, reported, c.unit, true});
  }
  out.push_back({"R2", fit.r2, reported, "", true});
  out.push_back({"condition", fit.condition, reported, "", true});
  return out;
}

// Data and fit over x, and below them what the fit leaves.
void add_fit(std::vector<Chart>& charts, const std::string& group, const Fit& fit,
             const std::vector<Coefficient>& rows, const std::string& x_label,
             const std::vector<double>& x) {
  std::vector<double> fitted(fit.y.size());
  for (std::size_t i = 0; i < fitted.size(); ++i) fitted[i] = fit.y[i] - fit.residuals[i];
  const std::string unit = fit.unit.empty() ? "" : " / (" + fit.unit + ")";
  charts.push_back({group,
                    fit.name,
                    x_label,
                    fit.wanted + unit,
                    "",
                    "",
                    {{"measured", x, fit.y, true}, {"fit", x, fitted, true}},
                    figures(fit, rows)});
  charts.push_back({group,
                    fit.name + ": residuals",
                    x_label,
                    "measured - fit" + unit,
                    "",
                    "",
                    {{"residual", x, fit.residuals, true}},
                    {}});
}

}  // namespace

std::vector<Chart> charts(const Calibration& c) {
  std::vector<Chart> all;
  const auto rpm = [](const auto& p) { return rpm_of(p.speed_radps); };
  const std::vector<SteadyPoint> working = working_points(c.data);
  add_fit(all, "Current sense", c.sense.fit, {c.sense.gain, c.sense.offset},
          "bus current by the stand's ammeter / A",
          column(c.data.still, [](const auto& p) { return p.meter_A; }));
  add_fit(all, "Motor", c.motor.torque, {c.motor.torque_constant, c.motor.no_load_current},
          "torque by the load cell / (N m)",
          column(working, [](const auto& p) { return p.torque_Nm; }));
  add_fit(all, "Motor", c.motor.losses, c.motor.losses.coefficients, "speed / rpm",
          column(working, rpm));
  std::vector<double> x = column(c.data.sinusoid, rpm);
  for (const SteadyPoint& p : c.data.still) x.push_back(rpm(p));
  add_fit(all, "Motor", c.motor.voltage, {c.motor.back_emf, c.motor.resistance, c.motor.overlap},
          "speed / rpm", x);
  const auto still = column(c.data.still, rpm);
  add_fit(all, "Propeller in still air", c.still.thrust, c.still.a, "speed / rpm", still);
  add_fit(all, "Propeller in still air", c.still.torque, c.still.q, "speed / rpm", still);
  const auto lambda = column(c.rotor.points, [](const auto& p) { return p.li + p.ls; });
  add_fit(all, "Propeller in wind", c.rotor.power,
          {c.rotor.c0, c.rotor.d0, c.rotor.d1, c.rotor.speed_effect}, "inflow ratio lambda",
          lambda);
  add_fit(all, "Propeller in wind", c.rotor.line, {c.rotor.c1, c.rotor.c2}, "inflow ratio lambda",
          lambda);
  const auto ct = column(c.rotor.points, [](const auto& p) { return p.CT; });
  all.push_back(
      {"Propeller in wind",
       "induced power factor kappa",
       "CT / (N s2/rad2)",
       "kappa",
       "",
       "",
       {{"points", ct, column(c.rotor.points, [](const auto& p) { return p.kappa; }), true},
        {"d0 + d1 CT", ct,
         column(c.rotor.points,
                [&](const auto& p) { return c.rotor.d0.value + c.rotor.d1.value * p.CT; }),
         true}},
       {}});
  std::vector<double> errors = found_back(c.rotor);
  for (double& e : errors) e *= 100.0;
  all.push_back(
      {"Propeller in wind",
       "thrust found back from power",
       "wind / (m/s)",
       "error / %",
       "",
       "Points that are missing: power does not tell the inflow there.",
       {{"error", column(c.rotor.points, [](const auto& p) { return p.wind_mps; }), errors, true}},
       {}});
  return all;
}

}  // namespace whirl::calibrate
