#include "plant/validation/discharge_proof.hpp"

#include <algorithm>
#include <cmath>

#include "plant/battery/battery.hpp"
#include "plant/validation/report.hpp"

namespace whirl::plant {
namespace {

struct Allowed {
  double current_A;
  const char* name;
  double rms_mV, worst_mV;
};
constexpr double kNot_judged = std::numeric_limits<double>::infinity();
constexpr Allowed kCurrents[] = {{0.228, "0.1 C, fitted", 18.0, kNot_judged},
                                 {1.14, "0.5 C, fitted", 9.0, kNot_judged},
                                 {2.28, "1 C, fitted", 5.0, kNot_judged},
                                 {4.56, "2 C, kept aside", 30.0, 50.0}};
constexpr double kStep_s = 0.5;

void discharge(const BatteryParams& params, int cells, const Allowed& allowed, const Rows& rows,
               Proof& proof) {
  Battery pack(params);
  Curve model{allowed.name, {}, {}}, reference{std::string(allowed.name) + ", measured", {}, {}};
  double time_s = 0.0, squares = 0.0, worst_V = 0.0;
  for (const auto& row : rows) {
    if (row[0] != allowed.current_A) continue;
    for (; time_s < row[1]; time_s += kStep_s) pack.draw(row[0] * kStep_s, kStep_s);
    const double cell_V = (pack.source_V() - pack.series_resistance_ohm() * row[0]) / cells;
    model.x.push_back(row[1]), model.y.push_back(cell_V);
    reference.x.push_back(row[1]), reference.y.push_back(row[2]);
    squares += (cell_V - row[2]) * (cell_V - row[2]);
    worst_V = std::max(worst_V, std::abs(cell_V - row[2]));
  }
  // No rows: not a number, and so not within.
  const double rms_V = std::sqrt(squares / static_cast<double>(model.x.size()));
  proof.model.push_back(model), proof.reference.push_back(reference);
  const std::string name = std::string("discharge at ") + allowed.name;
  proof.figures.push_back({name + ", rms of a cell", 1e3 * rms_V, allowed.rms_mV, "mV"});
  proof.figures.push_back({name + ", worst", 1e3 * worst_V, allowed.worst_mV, "mV"});
}

}  // namespace

Proof discharge_proof(const BatteryParams& pack, int cells, const std::string& text) {
  Proof proof{.title = "Discharges of the pouch cell of lco_4s_2340.lua",
              .x_label = "time / s",
              .y_label = "voltage of a cell / V",
              .source = "Enertech"};
  const Rows rows = read_rows(text, 3);
  for (const Allowed& allowed : kCurrents) discharge(pack, cells, allowed, rows, proof);
  return proof;
}

}  // namespace whirl::plant
