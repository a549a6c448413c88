#include "results/charts.hpp"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/json_text.hpp"
#include "results/legal_json.hpp"
#include "results/page_text.hpp"

namespace whirl::results {
namespace {

using nlohmann::ordered_json;

ordered_json number(double x) {
  return std::isfinite(x) ? ordered_json(x) : ordered_json(nullptr);
}

ordered_json numbers(const std::vector<double>& values) {
  ordered_json out = ordered_json::array();
  for (double v : values) out.push_back(number(v));
  return out;
}

ordered_json chart_json(const Chart& chart) {
  ordered_json out = {{"group", chart.group},     {"title", chart.title},
                      {"x_label", chart.x_label}, {"y_label", chart.y_label},
                      {"source", chart.source},   {"note", chart.note}};
  out["curves"] = out["figures"] = ordered_json::array();
  for (const ChartCurve& c : chart.curves) {
    out["curves"].push_back({{"name", c.in_legend ? c.name : ""},
                             {"x", numbers(c.x)},
                             {"y", numbers(c.y)},
                             {"marks", c.marks},
                             {"faint", c.faint}});
  }
  for (const ChartFigure& f : chart.figures) {
    out["figures"].push_back({{"name", f.name},
                              {"measured", number(f.measured)},
                              {"limit", number(f.limit)},
                              {"unit", f.unit},
                              {"ok", f.ok}});
  }
  return out;
}

ordered_json table_json(const ChartTable& table) {
  ordered_json out = {{"title", table.title}, {"rows", table.rows}};
  out["heads"] = ordered_json::array();
  for (const ChartTable::Head& head : table.heads) {
    out["heads"].push_back({head.text, head.number ? "n" : ""});
  }
  return out;
}

}  // namespace

std::string charts_html(const std::string& title, const std::string& about,
                        const std::vector<Chart>& charts, const std::vector<ChartTable>& tables) {
  ordered_json data = {{"title", title}, {"about", about}};
  data["tables"] = ordered_json::array();
  for (const ChartTable& t : tables) data["tables"].push_back(table_json(t));
  data["charts"] = ordered_json::array();
  for (const Chart& chart : charts) data["charts"].push_back(chart_json(chart));
  make_legal(data);
  return fill_page(kChartsPage, text_of(data));
}

std::string figures_text(const std::vector<Chart>& charts) {
  std::string text, shown;
  char line[256];
  for (const Chart& chart : charts) {
    for (const ChartFigure& f : chart.figures) {
      if (shown != chart.title) text += printable_line(chart.title) + "\n";
      shown = chart.title;
      const char* verdict = std::isinf(f.limit) ? "    " : f.ok ? "ok  " : "FAIL";
      std::snprintf(line, sizeof line, "  %s %-58s %10.4g %-8s", verdict, f.name.c_str(),
                    f.measured, f.unit.c_str());
      text += line;
      if (!std::isinf(f.limit)) {
        std::snprintf(line, sizeof line, " limit %.4g", f.limit);
        text += line;
      }
      text += "\n";
    }
  }
  return text;
}

namespace {

// A name may hold what separates fields and lines.
std::string field(const std::string& text) {
  if (text.find_first_of(";\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string row(std::initializer_list<std::string> fields) {
  std::string line;
  for (const std::string& text : fields) line += (line.empty() ? "" : ";") + field(text);
  return line + "\n";
}

std::string nine_digits(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", x);
  return text;
}

}  // namespace

std::string curves_csv(const std::vector<Chart>& charts) {
  std::string text = "group;chart;curve;x_label;x;y_label;y\n";
  for (const Chart& chart : charts) {
    for (const ChartCurve& curve : chart.curves) {
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        text += row({chart.group, chart.title, curve.name, chart.x_label, nine_digits(curve.x[i]),
                     chart.y_label, nine_digits(curve.y[i])});
      }
    }
  }
  return text;
}

std::string figures_csv(const std::vector<Chart>& charts) {
  std::string text = "group;chart;figure;value;unit;limit;note\n";
  for (const Chart& chart : charts) {
    for (const ChartFigure& f : chart.figures) {
      text += row({chart.group, chart.title, f.name, nine_digits(f.measured), f.unit,
                   std::isinf(f.limit) ? "" : nine_digits(f.limit), ""});
    }
    if (!chart.note.empty()) text += row({chart.group, chart.title, "", "", "", "", chart.note});
  }
  return text;
}

}  // namespace whirl::results
