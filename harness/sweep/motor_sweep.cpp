#include "harness/sweep/motor_sweep.hpp"

#include <cmath>
#include <cstdio>

#include "base/rpm.hpp"
#include "harness/sweep/steady_motor.hpp"
#include "harness/sweep/tally.hpp"

namespace whirl::sweep {
namespace {

using regression::Coefficient;
using results::Chart;

Chart chart_over(const std::string& x_label, const std::string& title, const std::string& y_label) {
  return {"Motor at full throttle", title, x_label, y_label, "", "", {{"model", {}, {}}}, {}};
}

// From no load to where resistance takes three tenths of the voltage.
std::vector<Chart> over_torque(const plant::MotorParams& motor, double bus_V) {
  const std::string x = "torque / N m";
  Chart speed = chart_over(x, "Speed", "speed / rpm"),
        amps = chart_over(x, "Current", "current / A");
  Chart share = chart_over(x, "Efficiency", "shaft power over electrical power");
  plant::AveragedMotor running(motor);
  running.set_speed(bus_V / motor.torque_constant_NmpA);
  const double top_Nm = motor.torque_constant_NmpA * 0.3 * bus_V / motor.resistance_ohm;
  for (int i = 0; i <= 24; ++i) {
    const double torque_Nm = top_Nm * i / 24.0;
    const auto books = run_until_steady(running, {.bus_V = bus_V, .duty = 1.0}, [&](double) {
      return plant::ShaftLoad{0.0, torque_Nm};
    });
    const double bus_A = books.bus_charge_C / (kSubSteps * kSubStep_s);
    for (Chart* chart : {&speed, &amps, &share}) chart->curves[0].x.push_back(torque_Nm);
    speed.curves[0].y.push_back(rpm_of(running.speed_radps()));
    amps.curves[0].y.push_back(bus_A);
    share.curves[0].y.push_back(torque_Nm * running.speed_radps() / (bus_V * bus_A));
  }
  return {speed, amps, share};
}

void lay_over(const plant::MotorParams& motor, const std::vector<DriveFile>& measured,
              MotorSweep& sweep) {
  Chart chart =
      chart_over("bus current / A", "Speed at the measured voltage and current", "speed / rpm");
  chart.curves.clear();
  Tally tally;
  for (const DriveFile& file : measured) {
    results::ChartCurve points{file.name, {}, {}, true}, told{"model", {}, {}, true};
    for (const DriveRow& row : file.rows) {
      if (row.duty < kFull_throttle) continue;
      const double speed_radps = speed_at(row, motor);
      tally.add(speed_radps, row.speed_radps);
      points.x.push_back(row.bus_A), points.y.push_back(rpm_of(row.speed_radps));
      told.x.push_back(row.bus_A), told.y.push_back(rpm_of(speed_radps));
    }
    chart.curves.push_back(told), chart.curves.push_back(points);
  }
  sweep.speed_percent = tally.wmape_percent();
  chart.figures.push_back({"speed, WMAPE", sweep.speed_percent, kMost_speed_percent, "%",
                           sweep.speed_percent <= kMost_speed_percent});
  chart.figures.push_back(
      {"speed, mean error", tally.mean_percent(), std::numeric_limits<double>::infinity(), "%"});
  sweep.charts.insert(sweep.charts.begin(), chart);
}

std::string interval(const Coefficient& c, double scale, const char* unit) {
  char text[120];
  std::snprintf(text, sizeof text, "%s: %.4g +- %.2g %s (95 %%)", c.name.c_str(), scale * c.value,
                scale * c.half_width, unit);
  return text;
}

struct Side {  // a constant by the rows, and by the file
  const std::optional<Coefficient>& by_rows;
  double by_file, may_differ;  // the second a share
  double scale;
  const char* unit;
};

void compare(const Side& side, MotorSweep& sweep) {
  if (!side.by_rows) return;
  const Coefficient& c = *side.by_rows;
  char text[60];
  std::snprintf(text, sizeof text, "; the file: %.4g %s", side.scale * side.by_file, side.unit);
  sweep.lines.push_back(interval(c, side.scale, side.unit) + text);
  const double most = c.half_width + side.may_differ * std::abs(c.value);
  if (!(std::abs(side.by_file - c.value) <= most)) sweep.wrong.push_back(sweep.lines.back());
}

void tell(const MotorConstants& found, const plant::MotorParams& motor, MotorSweep& sweep) {
  constexpr double kMohm = 1e3;
  compare({found.kv_rpm_per_V, rpm_of(1.0 / motor.torque_constant_NmpA), 0.03, 1.0, "rpm/V"},
          sweep);
  if (found.seen_ohm) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "; commutation looks like %.3g mohm of it at the rows' mean speed, and counts "
                  "more than once where current rises with speed",
                  kMohm * found.commutation_ohm);
    Coefficient seen = *found.seen_ohm;
    seen.name = "R seen at the input";
    sweep.lines.push_back(interval(seen, kMohm, "mohm") + text);
  }
  compare({found.ohmmeter_ohm, motor.resistance_ohm, 0.10, kMohm, "mohm"}, sweep);
  if (found.winding_ohm) {
    sweep.lines.push_back(interval(*found.winding_ohm, kMohm, "mohm") +
                          ": what a data sheet prints, if bridge and leads are the file's");
  }
  compare({found.no_load_A, motor.no_load_current_A, 0.25, 1.0, "A"}, sweep);
  for (const std::string& note : found.notes) sweep.lines.push_back("note: " + note);
  for (const std::string& what : found.untold) sweep.lines.push_back("not told: " + what);
}

}  // namespace

Result<MotorSweep> motor_sweep(const plant::MotorParams& motor, double bus_V,
                               const std::vector<DriveFile>& measured) {
  MotorSweep sweep;
  sweep.charts = over_torque(motor, bus_V);
  if (measured.empty()) return sweep;
  const auto found = motor_constants(measured, motor);
  if (!found) return found.error();
  tell(found.value(), motor, sweep);
  lay_over(motor, measured, sweep);
  return sweep;
}

}  // namespace whirl::sweep
