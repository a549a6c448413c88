// A page of charts, and the same as a table for the terminal: validation and sweeps.
#pragma once
#include <limits>
#include <string>
#include <vector>

namespace whirl::results {

struct ChartCurve {
  std::string name;  // "": not in the legend
  std::vector<double> x, y;
  bool marks = false;  // points of a reference instead of a line
  bool faint = false;  // one of many: thin and pale
  bool in_legend = true;
};

struct ChartFigure {
  std::string name;
  double measured = 0.0;
  double limit = std::numeric_limits<double>::infinity();  // infinite: only reported
  std::string unit;
  bool ok = true;
};

struct Chart {
  std::string group, title, x_label, y_label, source, note;
  std::vector<ChartCurve> curves;
  std::vector<ChartFigure> figures;
};

struct ChartTable {  // above the charts
  struct Head {
    std::string text;
    bool number = false;  // to the right
  };
  std::string title;
  std::vector<Head> heads;
  std::vector<std::vector<std::string>> rows;  // a text per head
};

std::string charts_html(const std::string& title, const std::string& about,
                        const std::vector<Chart>& charts,
                        const std::vector<ChartTable>& tables = {});
std::string figures_text(const std::vector<Chart>& charts);  // a line per figure
// Fields apart by ';', a field that holds one in quotes (RFC 4180).
std::string curves_csv(const std::vector<Chart>& charts);  // group;chart;curve;x_label;x;y_label;y
std::string figures_csv(
    const std::vector<Chart>& charts);  // group;chart;figure;value;unit;limit;note

}  // namespace whirl::results
