#include "plant/battery/battery.hpp"

#include <algorithm>
#include <cmath>

#include "base/check.hpp"
#include "plant/base/bounds.hpp"

namespace whirl::plant {

// Four cells: 4.2 V each when full, the plateau, the knee near empty. Ten minutes of hover take 42 %
// of the charge; resistances such that they end at 14.5 to 15 V [Bangura2017, fig. 2.11].
BatteryParams lipo_4s_2200() {
  BatteryParams p;
  p.open_circuit = {{0.0, 16.80}, {0.1, 16.40}, {0.2, 16.05}, {0.3, 15.70}, {0.42, 15.30},
                    {0.6, 15.00}, {0.8, 14.75}, {0.9, 14.50}, {0.95, 14.2}, {1.0, 13.0}};
  p.series_resistance_ohm = 0.030;
  p.relaxation_resistance_ohm = 0.040;
  p.relaxation_time_s = 30.0;
  return p;
}

BatteryParams lab_supply(double voltage_V, double resistance_ohm) {
  BatteryParams p;
  p.open_circuit = {{0.0, voltage_V}, {1.0, voltage_V}};
  p.capacity_C = std::numeric_limits<double>::infinity();
  p.series_resistance_ohm = resistance_ohm;
  return p;
}

Result<Done> validate(const BatteryParams& p, const std::string& place) {
  Bounds b(place);
  b.require(p.open_circuit.size() >= 2, "open-circuit curve has fewer than two points");
  for (std::size_t i = 0; i < p.open_circuit.size(); ++i) {
    b.within("open-circuit voltage_V", p.open_circuit[i].voltage_V, 0.1, 1000.0);
    b.require(
        i == 0 || p.open_circuit[i].depth_of_discharge > p.open_circuit[i - 1].depth_of_discharge,
        "open-circuit curve: depth of discharge must rise from point to point");
  }
  if (p.open_circuit.size() >= 2) {
    b.require(p.open_circuit.front().depth_of_discharge == 0.0 &&
                  p.open_circuit.back().depth_of_discharge == 1.0,
              "open-circuit curve must run from depth of discharge 0 to 1");
  }
  b.require(p.capacity_C > 0.0, "capacity must be positive");
  b.within("series_resistance_ohm", p.series_resistance_ohm, 0.0, 10.0);
  b.within("relaxation_resistance_ohm", p.relaxation_resistance_ohm, 0.0, 10.0);
  b.within("relaxation_time_s", p.relaxation_time_s, 1e-3, 1e5);
  b.within("initial_depth_of_discharge", p.initial_depth_of_discharge, 0.0, 1.0);
  return b.result();
}

Battery::Battery(const BatteryParams& params) : params_(params) {
  WHIRL_CHECK(validate(params, "battery").ok());
  source_V_ = open_circuit_V();
}

double Battery::depth_of_discharge() const {
  return params_.initial_depth_of_discharge + used_C_ / params_.capacity_C;
}

double Battery::open_circuit_V() const {
  const double depth = depth_of_discharge();
  const auto& curve = params_.open_circuit;
  std::size_t i = 1;
  while (i + 1 < curve.size() && depth > curve[i].depth_of_discharge) ++i;
  const auto &a = curve[i - 1], &b = curve[i];
  const double slope = (b.voltage_V - a.voltage_V) / (b.depth_of_discharge - a.depth_of_discharge);
  return std::max(0.0, a.voltage_V + slope * (depth - a.depth_of_discharge));
}

BatteryBooks& BatteryBooks::operator+=(const BatteryBooks& other) {
  chemical_J += other.chemical_J;
  series_J += other.series_J;
  relaxation_J += other.relaxation_J;
  dip_J += other.dip_J;
  return *this;
}

BatteryBooks Battery::draw(double charge_C, double dt_s) {
  const BatteryBooks books{
      .chemical_J = (source_V_ + relaxation_V_) * charge_C,
      .series_J = params_.series_resistance_ohm * charge_C * charge_C / dt_s,
      .relaxation_J = relaxation_V_ * charge_C,
      .dip_J = dip_V_ * charge_C,
  };
  if (dt_s != last_dt_s_) {
    last_dt_s_ = dt_s;
    last_blend_ = -std::expm1(-dt_s / params_.relaxation_time_s);
  }
  used_C_ += charge_C;
  const double settled_V = params_.relaxation_resistance_ohm * charge_C / dt_s;
  relaxation_V_ += (settled_V - relaxation_V_) * last_blend_;
  source_V_ = open_circuit_V() - relaxation_V_;
  return books;
}

}  // namespace whirl::plant
