// The bound as a table and as charts: over thrust and voltage, right after a calibration and on another day.
#pragma once
#include <vector>

#include "harness/inflow_bound/bound.hpp"
#include "results/charts.hpp"

namespace whirl::inflow_bound {

struct Report {
  results::ChartTable table;  // from which inflow on, per thrust, voltage, prior and doubts
  std::vector<results::Chart> charts;
};

Report report(const Copy& copy, const std::vector<double>& thrust_N,
              const std::vector<double>& bus_V);

// The table for a terminal.
std::string text(const results::ChartTable& table);

}  // namespace whirl::inflow_bound
