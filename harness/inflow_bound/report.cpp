#include "harness/inflow_bound/report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace whirl::inflow_bound {
namespace {

struct Case {
  const char* words;
  Prior prior;
  Doubts doubts;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"calibrated, from above", Prior::from_above, as_calibrated()},
      {"calibrated, from anywhere", Prior::any, as_calibrated()},
      {"another day, from above", Prior::from_above, another_day()},
      {"another day, from anywhere", Prior::any, another_day()},
  };
  return all;
}

std::string number(const char* form, double value) {
  char text[40];
  std::snprintf(text, sizeof text, form, value);
  return text;
}

results::ChartCurve curve_of(const Bound& bound, const char* name, double (*value)(const Point&)) {
  results::ChartCurve curve{name, {}, {}};
  for (const Point& p : bound.points) {
    curve.x.push_back(p.inflow_mps);
    curve.y.push_back(100.0 * value(p));
  }
  return curve;
}

results::Chart chart_of(const std::vector<Bound>& bounds) {
  const Bound& first = bounds.front();
  results::Chart chart;
  chart.group = "Thrust from power: what can be told";
  chart.title = number("%.1f N", first.thrust_N) + number(" at %.1f V", first.bus_V);
  chart.x_label = "air from above / (m/s)";
  chart.y_label = "two sigma of thrust / %";
  chart.note =
      "Told is what lies below a third of the static map's loss. A propeller takes as much power "
      "in an updraft as "
      "in some downdraft: who may be in either believes the wrong one below the last step of the "
      "curve.";
  chart.curves.push_back(curve_of(first, "a third of what the static map loses",
                                  [](const Point& p) { return std::abs(p.rpm_error) / 3.0; }));
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    chart.curves.push_back(
        curve_of(bounds[i], cases()[i].words, [](const Point& p) { return p.sigma2; }));
  }
  return chart;
}

}  // namespace

Report report(const Copy& copy, const std::vector<double>& thrust_N,
              const std::vector<double>& bus_V) {
  Report out;
  out.table.title =
      "Air from above is told from (two sigma of thrust within a third of the static map's loss)";
  out.table.heads = {{"thrust", true}, {"bus", true}};
  for (const Case& c : cases()) out.table.heads.push_back({c.words, true});
  const auto [least, most] = std::minmax_element(thrust_N.begin(), thrust_N.end());
  const BoundFinder finder(copy, *least, *most, *std::max_element(bus_V.begin(), bus_V.end()));
  for (const double N : thrust_N) {
    for (const double V : bus_V) {
      std::vector<std::string> row = {number("%.1f N", N), number("%.1f V", V)};
      std::vector<Bound> bounds;
      for (const Case& c : cases()) {
        bounds.push_back(finder.at(c.doubts, c.prior, N, V));
        const auto& told = bounds.back().told_from_mps;
        row.push_back(told ? number("%.1f m/s", *told) : "not told");
      }
      out.table.rows.push_back(std::move(row));
      if (V == bus_V.back()) out.charts.push_back(chart_of(bounds));
    }
  }
  return out;
}

std::string text(const results::ChartTable& table) {
  std::string out = table.title + "\n ";
  for (const auto& head : table.heads) {
    out += "  " + std::string(head.text.size() < 8 ? 8 - head.text.size() : 0, ' ') + head.text;
  }
  for (const auto& row : table.rows) {
    out += "\n ";
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::size_t width = std::max<std::size_t>(8, table.heads[i].text.size());
      out += "  " + std::string(width - std::min(width, row[i].size()), ' ') + row[i];
    }
  }
  return out + "\n";
}

}  // namespace whirl::inflow_bound
