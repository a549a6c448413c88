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

namespace {

constexpr double kLeast_factor = 0.01, kMost_factor = 100.0;

void check_factors(const BatteryParams& p, Bounds& b) {
  const auto& depths = p.resistance_over_depth;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    b.within("resistance over charge: depth", depths[i].depth_of_discharge, 0.0, 1.0);
    b.within("resistance over charge: factor", depths[i].factor, kLeast_factor, kMost_factor);
    b.require(i == 0 || depths[i].depth_of_discharge > depths[i - 1].depth_of_discharge,
              "resistance over charge: depth must rise from point to point");
  }
  const auto& warmth = p.resistance_over_temperature;
  for (std::size_t i = 0; i < warmth.size(); ++i) {
    b.within("resistance over temperature: factor", warmth[i].factor, kLeast_factor, kMost_factor);
    b.require(i == 0 || warmth[i].temperature_K > warmth[i - 1].temperature_K,
              "resistance over temperature: temperature must rise from point to point");
  }
  b.within("temperature_K", p.temperature_K, 230.0, 350.0);
  if (warmth.empty()) return;
  b.require(p.temperature_K >= warmth.front().temperature_K &&
                p.temperature_K <= warmth.back().temperature_K,
            "the cells' temperature lies outside what is told of their resistance");
}

// Straight between points, level beyond them; 1 where there are none. `at` and `factor` are members.
template <typename Point>
double factor_at(const std::vector<Point>& points, double Point::*at, double x) {
  if (points.empty()) return 1.0;
  if (x <= points.front().*at) return points.front().factor;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Point &a = points[i - 1], &b = points[i];
    if (x <= b.*at) return a.factor + (b.factor - a.factor) * (x - a.*at) / (b.*at - a.*at);
  }
  return points.back().factor;
}

}  // namespace

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
  for (std::size_t i = 1; i < p.open_circuit.size(); ++i) {
    b.require(p.open_circuit[i].voltage_V <= p.open_circuit[i - 1].voltage_V,
              "open-circuit curve: the voltage must not rise as the pack is emptied");
  }
  b.require(p.capacity_C > 0.0, "capacity must be positive");
  b.within("series_resistance_ohm", p.series_resistance_ohm, 0.0, 10.0);
  b.within("relaxation_resistance_ohm", p.relaxation_resistance_ohm, 0.0, 10.0);
  b.within("relaxation_time_s", p.relaxation_time_s, 1e-3, 1e5);
  b.within("slow_relaxation_resistance_ohm", p.slow_relaxation_resistance_ohm, 0.0, 10.0);
  b.within("slow_relaxation_time_s", p.slow_relaxation_time_s, 1e-3, 1e5);
  check_factors(p, b);
  b.within("initial_depth_of_discharge", p.initial_depth_of_discharge, 0.0, 1.0);
  return b.result();
}

Battery::Battery(const BatteryParams& params)
    : params_(params),
      warmth_factor_(factor_at(params.resistance_over_temperature,
                               &ResistanceOverTemperature::temperature_K, params.temperature_K)),
      fast_{.ohm = params.relaxation_resistance_ohm, .time_s = params.relaxation_time_s},
      slow_{.ohm = params.slow_relaxation_resistance_ohm, .time_s = params.slow_relaxation_time_s} {
  WHIRL_CHECK(validate(params, "battery").ok());
  look_up();
}

void Battery::look_up() {
  factor_ = warmth_factor_;
  if (!params_.resistance_over_depth.empty()) {
    factor_ *= factor_at(params_.resistance_over_depth, &ResistanceOverDepth::depth_of_discharge,
                         depth_of_discharge());
  }
  series_ohm_ = factor_ * params_.series_resistance_ohm;
  source_V_ = open_circuit_V() - fast_.voltage_V - slow_.voltage_V;
}

double Battery::settled_resistance_ohm() const {
  return series_ohm_ + factor_ * (fast_.ohm + slow_.ohm);
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
  const double relaxation_V = fast_.voltage_V + slow_.voltage_V;
  const BatteryBooks books{
      .chemical_J = (source_V_ + relaxation_V) * charge_C,
      .series_J = series_ohm_ * charge_C * charge_C / dt_s,
      .relaxation_J = relaxation_V * charge_C,
      .dip_J = dip_V_ * charge_C,
  };
  for (Branch* branch : {&fast_, &slow_}) {
    if (branch->ohm == 0.0) continue;  // eight times a step, of every pack
    if (dt_s != last_dt_s_) branch->blend = -std::expm1(-dt_s / branch->time_s);
    const double settled_V = factor_ * branch->ohm * charge_C / dt_s;
    branch->voltage_V += (settled_V - branch->voltage_V) * branch->blend;
  }
  last_dt_s_ = dt_s;
  used_C_ += charge_C;
  look_up();
  return books;
}

}  // namespace whirl::plant
