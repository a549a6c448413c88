#include "harness/sweep/stand_sweep.hpp"

#include <cmath>

#include "base/rpm.hpp"
#include "harness/sweep/tally.hpp"
#include "plant/battery/battery.hpp"

namespace whirl::sweep {
namespace {

using results::Chart;

constexpr double kMore_voltage = 1.3;

Result<DrivePoint> at_bus(const flight::FlightParams& stand, const DriveFile& file,
                          const DriveRow& row, double bus_V) {
  if (file.duty) return drive_point(stand, row.duty * bus_V, bus_V);
  auto point = drive_at_speed(stand, row.speed_radps, bus_V);
  if (point) return point;
  // Measured to turn as fast as the model cannot: what it would take of a higher voltage, as power of this one.
  auto more = drive_at_speed(stand, row.speed_radps, kMore_voltage * bus_V);
  if (!more) return point.error();
  more.value().bus_A = more.value().electrical_W / bus_V;
  return more;
}

// The feed's voltage falls with the current that it makes necessary.
Result<DrivePoint> point_of_row(const flight::FlightParams& stand, const DriveFile& file,
                                const DriveRow& row, double feed_V) {
  if (file.volts) return at_bus(stand, file, row, row.bus_V);
  const plant::Battery full(stand.vehicle.battery);
  const double source_V = feed_V > 0.0 ? feed_V : full.open_circuit_V();
  const double ohm = feed_V > 0.0 ? 0.0 : full.series_resistance_ohm();
  double bus_V = source_V;
  auto point = at_bus(stand, file, row, bus_V);
  for (int i = 0; i < 8 && point; ++i) {
    const double next_V = std::max(0.1, source_V - ohm * point.value().bus_A);
    const bool stays = std::abs(next_V - bus_V) < 1e-3;
    bus_V = next_V;
    if (stays) break;
    point = at_bus(stand, file, row, bus_V);
  }
  return point;
}

struct Quantity {
  const char *what, *label;
  bool (*measured)(const DriveFile&);
  double (*of_row)(const DriveRow&);
  double (*of_model)(const DrivePoint&);
};
const Quantity kQuantities[] = {
    {"speed", "speed / rpm", [](const DriveFile& f) { return f.duty; },
     [](const DriveRow& r) { return rpm_of(r.speed_radps); },
     [](const DrivePoint& p) { return rpm_of(p.speed_radps); }},
    {"current", "bus current / A", [](const DriveFile&) { return true; },
     [](const DriveRow& r) { return r.bus_A; }, [](const DrivePoint& p) { return p.bus_A; }},
    {"thrust", "thrust / N", [](const DriveFile& f) { return f.thrust; },
     [](const DriveRow& r) { return r.thrust_N; }, [](const DrivePoint& p) { return p.thrust_N; }},
    {"torque", "torque / N m", [](const DriveFile& f) { return f.torque; },
     [](const DriveRow& r) { return r.torque_Nm; },
     [](const DrivePoint& p) { return p.torque_Nm; }},
};

struct Told {
  const DriveFile* file;
  std::vector<DrivePoint> points;  // one per row
};

void add_chart(const Quantity& q, const std::vector<Told>& all, StandSweep& sweep) {
  Chart chart{"The stand, row by row", q.what, "", q.label, "", "", {}, {}};
  Tally tally;
  for (const Told& told : all) {
    if (!q.measured(*told.file)) continue;
    results::ChartCurve model{"model", {}, {}, true}, marks{told.file->name, {}, {}, true};
    chart.x_label = told.file->duty ? "duty" : "measured speed / rpm";
    for (std::size_t i = 0; i < told.points.size(); ++i) {
      const DriveRow& row = told.file->rows[i];
      const double x = told.file->duty ? row.duty : rpm_of(row.speed_radps);
      model.x.push_back(x), model.y.push_back(q.of_model(told.points[i]));
      marks.x.push_back(x), marks.y.push_back(q.of_row(row));
      tally.add(model.y.back(), marks.y.back());
    }
    chart.curves.push_back(model), chart.curves.push_back(marks);
  }
  if (tally.n == 0) return;
  for (const Allowed& allowed : kStand_allowed) {
    if (std::string(allowed.what) != q.what) continue;
    const double off = tally.wmape_percent();
    chart.figures.push_back(
        {std::string(q.what) + ", WMAPE", off, allowed.percent, "%", off <= allowed.percent});
  }
  chart.figures.push_back({std::string(q.what) + ", mean error", tally.mean_percent(),
                           std::numeric_limits<double>::infinity(), "%"});
  sweep.off_percent[q.what] = tally.wmape_percent();
  sweep.charts.push_back(chart);
}

}  // namespace

Result<StandSweep> stand_rows(const flight::FlightParams& stand, const Options& options,
                              const std::vector<DriveFile>& measured) {
  StandSweep sweep;
  std::vector<Told> all;
  for (const DriveFile& file : measured) {
    Told& told = all.emplace_back(Told{&file, {}});
    for (const DriveRow& row : file.rows) {
      const auto point = point_of_row(stand, file, row, options.bus_V);
      if (!point) return point.error();
      told.points.push_back(point.value());
      ++sweep.rows;
    }
  }
  for (const Quantity& q : kQuantities) add_chart(q, all, sweep);
  return sweep;
}

Result<StandSweep> stand_sweep(const flight::FlightParams& stand, const Options& options,
                               const std::vector<DriveFile>& measured) {
  auto sweep = stand_rows(stand, options, measured);
  if (!sweep) return sweep;
  for (Chart& chart : drive_sweep(stand, options)) sweep.value().charts.push_back(std::move(chart));
  return sweep;
}

}  // namespace whirl::sweep
