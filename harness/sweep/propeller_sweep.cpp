#include <cmath>
#include <numbers>

#include "base/rpm.hpp"
#include "harness/sweep/sweep.hpp"
#include "harness/sweep/validity_tally.hpp"
#include "plant/rotor/rotor.hpp"

namespace whirl::sweep {
namespace {

using plant::Rotor;
using plant::RotorConditions;
using plant::RotorLoads;
using results::Chart;
using results::ChartCurve;

struct Columns {  // what the charts of one sweep share
  std::vector<double> x, thrust_N, torque_Nm, power_W, merit, drag_N, ct, cp;
  ValidityTally validity;

  void add(double at, const RotorConditions& c, const RotorLoads& loads, double radius_m) {
    const double n = c.omega_radps / (2.0 * std::numbers::pi), d = 2.0 * radius_m;
    x.push_back(at);
    thrust_N.push_back(loads.thrust_N);
    torque_Nm.push_back(loads.shaft_torque_Nm);
    power_W.push_back(loads.shaft_power_W);
    merit.push_back(loads.figure_of_merit);
    drag_N.push_back(-loads.f_P_N.x());
    ct.push_back(loads.thrust_N / (c.density_kgpm3 * n * n * std::pow(d, 4)));
    cp.push_back(loads.shaft_power_W / (c.density_kgpm3 * n * n * n * std::pow(d, 5)));
    validity.add(at, loads.validity);
  }
  Chart chart(const std::string& group, const std::string& title, const std::string& x_label,
              const std::string& y_label, const std::vector<double>& y) const {
    return {group, title, x_label, y_label, "", validity.note(), {{"model", x, y, false}}, {}};
  }
};

void add_static(std::vector<Chart>& charts, const Rotor& rotor, const Options& o) {
  Columns columns;
  for (int i = 4; i <= 40; ++i) {
    RotorConditions c;
    c.omega_radps = o.top_speed_radps * i / 40.0;
    columns.add(rpm_of(c.omega_radps), c, rotor.steady(c), radius_m(rotor.blade()));
  }
  const std::string group = "Static, over speed", x = "speed / rpm";
  charts.push_back(columns.chart(group, "Thrust", x, "thrust / N", columns.thrust_N));
  charts.push_back(columns.chart(group, "Torque", x, "torque / N m", columns.torque_Nm));
  charts.push_back(columns.chart(group, "Shaft power", x, "power / W", columns.power_W));
  charts.push_back(columns.chart(group, "Figure of merit", x, "figure of merit", columns.merit));
}

void add_inflow(std::vector<Chart>& charts, const Rotor& rotor, double omega_radps) {
  Columns columns;
  for (double inflow_mps = -2.0; inflow_mps <= 6.01; inflow_mps += 0.25) {
    RotorConditions c;
    c.omega_radps = omega_radps;
    c.v_AP_P_mps = {0.0, 0.0, -inflow_mps};  // the hub climbs, so the air comes down through it
    columns.add(inflow_mps, c, rotor.steady(c), radius_m(rotor.blade()));
  }
  const std::string group =
      "Over axial inflow at " + std::to_string(std::lround(rpm_of(omega_radps))) + " rpm";
  const std::string x = "inflow from above / (m/s)";
  charts.push_back(columns.chart(group, "Thrust", x, "thrust / N", columns.thrust_N));
  charts.push_back(columns.chart(group, "Shaft power", x, "power / W", columns.power_W));
  Chart plane{group,
              "CT against CP",
              "CP",
              "CT",
              "",
              columns.validity.note(),
              {{"inflow -2 to 6 m/s", columns.cp, columns.ct, false}},
              {}};
  charts.push_back(plane);
}

void add_advance(std::vector<Chart>& charts, const Rotor& rotor, double omega_radps) {
  Columns columns;
  const double tip_mps = omega_radps * radius_m(rotor.blade());
  for (int i = 0; i <= 30; ++i) {
    RotorConditions c;
    c.omega_radps = omega_radps;
    c.v_AP_P_mps = {0.01 * i * tip_mps, 0.0, 0.0};
    columns.add(0.01 * i, c, rotor.steady(c), radius_m(rotor.blade()));
  }
  const std::string group = "Over advance ratio at " +
                            std::to_string(std::lround(rpm_of(omega_radps))) + " rpm, edgewise";
  const std::string x = "advance ratio (speed over tip speed)";
  charts.push_back(columns.chart(group, "Thrust", x, "thrust / N", columns.thrust_N));
  charts.push_back(columns.chart(group, "Shaft power", x, "power / W", columns.power_W));
  charts.push_back(
      columns.chart(group, "Drag in the disc (H-force)", x, "force / N", columns.drag_N));
}

}  // namespace

std::vector<Chart> propeller_sweep(const std::shared_ptr<const plant::Blade>& blade,
                                   const Options& options) {
  const Rotor rotor(blade, +1);
  const double omega =
      options.speed_radps > 0 ? options.speed_radps : 0.75 * options.top_speed_radps;
  std::vector<Chart> charts;
  add_static(charts, rotor, options);
  add_inflow(charts, rotor, omega);
  add_advance(charts, rotor, omega);
  return charts;
}

}  // namespace whirl::sweep
