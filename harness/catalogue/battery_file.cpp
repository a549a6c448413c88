#include "harness/catalogue/battery_file.hpp"

#include <algorithm>

#include "harness/lua/table.hpp"

namespace whirl::catalogue {
namespace {

using lua::above;
using lua::at_least;
using lua::between;
using lua::Table;

constexpr double kZero_celsius_K = 273.15;

void read_relaxation(const Table& t, plant::BatteryParams& b) {
  const std::vector<Table> branches = t.tables("relaxation");
  if (branches.empty() || branches.size() > 2) {
    return t.refuse("relaxation",
                    "one or two times are wanted, not " + std::to_string(branches.size()));
  }
  const auto ohm = [](const Table& r) {
    return r.quantity("resistance", Dimension::resistance, at_least(0.0));
  };
  const auto time_s = [](const Table& r) {
    return r.quantity("time", Dimension::time, between(1e-3, 1e5));
  };
  b.relaxation_resistance_ohm = ohm(branches[0]);
  b.relaxation_time_s = time_s(branches[0]);
  if (branches.size() == 1) return;
  b.slow_relaxation_resistance_ohm = ohm(branches[1]);
  b.slow_relaxation_time_s = time_s(branches[1]);
}

void read_factors(const Table& t, plant::BatteryParams& b) {
  if (t.has("resistance_over_charge")) {
    for (const Table& p : t.tables("resistance_over_charge")) {
      b.resistance_over_depth.push_back(
          {p.number("used", between(0.0, 1.0)), p.number("factor", above(0.0))});
    }
  }
  if (!t.has("resistance_over_temperature")) return;
  for (const Table& p : t.tables("resistance_over_temperature")) {
    b.resistance_over_temperature.push_back(
        {kZero_celsius_K + p.number("celsius"), p.number("factor", above(0.0))});
  }
}

// From one cell to all of them.
void join(int cells, int parallel, plant::BatteryParams& b) {
  const double ohms = static_cast<double>(cells) / parallel;
  for (plant::OpenCircuitPoint& p : b.open_circuit) p.voltage_V *= cells;
  b.capacity_C *= parallel;
  b.series_resistance_ohm *= ohms;
  b.relaxation_resistance_ohm *= ohms;
  b.slow_relaxation_resistance_ohm *= ohms;
}

}  // namespace

Result<plant::BatteryParams> read_battery_file(const std::string& path) {
  const auto file = lua::read_file(path);
  if (!file) return file.error();
  const Table& t = file.value();
  plant::BatteryParams b;
  std::ignore = t.choice("kind", {"battery"});
  std::ignore = t.text("name");
  const auto cells = static_cast<int>(t.integer("cells", 1, 100));
  const auto parallel = static_cast<int>(t.integer_or("parallel", 1, 1, 100));
  b.capacity_C = t.quantity("capacity", Dimension::charge, above(0.0));
  for (const Table& p : t.tables("open_circuit")) {
    b.open_circuit.push_back({p.number("used", between(0.0, 1.0)), p.number("V", above(0.0))});
  }
  b.series_resistance_ohm = t.quantity("resistance", Dimension::resistance, at_least(0.0));
  if (t.has("relaxation")) read_relaxation(t, b);
  read_factors(t, b);
  if (const auto good = t.finish(); !good) return good.error();
  join(cells, parallel, b);
  if (!b.resistance_over_temperature.empty()) {  // what was told is nearer than 25 degC
    b.temperature_K =
        std::clamp(b.temperature_K, b.resistance_over_temperature.front().temperature_K,
                   std::max(b.resistance_over_temperature.front().temperature_K,
                            b.resistance_over_temperature.back().temperature_K));
  }
  if (const auto good = plant::validate(b, path); !good) return good.error();
  return b;
}

}  // namespace whirl::catalogue
