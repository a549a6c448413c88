#include "harness/stand/stand_parts.hpp"

#include <algorithm>

#include "base/check.hpp"
#include "plant/motor/motor_params.hpp"
#include "plant/parts/esc_stand.hpp"
#include "plant/parts/vehicle.hpp"
#include "plant/sensors/current_shunt.hpp"

namespace whirl::stand {
namespace {

constexpr double kBus_capacitance_F = 470e-6;  // the power stage's own

double nominal_of_plant(const std::string& name) {
  const plant::MotorParams m;
  if (name == "torque_constant") return m.torque_constant_NmpA;
  if (name == "resistance") return m.resistance_ohm;
  if (name == "inductance") return m.inductance_H;
  if (name == "no_load_current") return m.no_load_current_A;
  if (name == "inertia") return m.inertia_kgm2;
  if (name == "shunt.pole") return plant::CurrentShuntParams{}.pole_Hz;
  WHIRL_CHECK(name == "bus_capacitance", name);
  return kBus_capacitance_F;
}

// stage: the motor of the board's power stage.
double nominal(const StandParams& params, const BoardDescription& board, int stage,
               const std::string& name) {
  if (const auto of_plan = params.stage.find(name); of_plan != params.stage.end()) {
    return of_plan->second;
  }
  for (const BoardDevice& device : board.devices) {
    if (device.type != "power_stage" || device.motor != stage) continue;
    const auto value = device.value("params." + name);
    if (value && std::holds_alternative<double>(*value)) return std::get<double>(*value);
  }
  return nominal_of_plant(name);
}

bool stated(const StandParams& params, const std::string& name) {
  return params.stage.count(name) > 0 ||
         (name == "shunt.gain_error" && params.stage.count("shunt.gain") > 0);
}

// The instruments' and clocks' numbers by their names; null: none of theirs.
double* number_beside_the_stage(StandParams& p, const std::string& name) {
  const std::pair<const char*, double*> all[] = {
      {"cell.thrust_gain", &p.cell.thrust_gain_error},
      {"cell.torque_gain", &p.cell.torque_gain_error},
      {"cell.thrust_offset", &p.cell.thrust_offset_N},
      {"cell.torque_offset", &p.cell.torque_offset_Nm},
      {"ammeter.gain", &p.ammeter.gain_error},
      {"ammeter.offset", &p.ammeter.offset},
      {"voltmeter.gain", &p.voltmeter.gain_error},
      {"voltmeter.offset", &p.voltmeter.offset},
      {"anemometer.gain", &p.anemometer.gain_error},
      {"anemometer.offset", &p.anemometer.offset},
      {"hse_error", &p.hse_error},
      {"hsi_error", &p.hsi_error},
  };
  for (const auto& [known, number] : all) {
    if (name == known) return number;
  }
  return nullptr;
}

// Resistors make a divider, the reference scales every channel: neither is a key of the stage.
void join_numbers(const std::map<std::string, double>& drawn, StageParams& stage) {
  const auto number = [&drawn](const std::string& name) {
    const auto found = drawn.find(name);
    return found == drawn.end() ? 0.0 : found->second;
  };
  for (const char* pin : {"a", "b", "c", "bus", "shunt"}) {
    const std::string divider = std::string("divider.") + pin;
    if (drawn.count(divider + ".upper") > 0) {
      stage[divider] = plant::divider_error(number(divider + ".upper"), number(divider + ".lower"));
    }
    // A reference that is high makes all that it measures look small.
    if (drawn.count("reference") > 0) {
      stage[std::string("adc.gain.") + pin] -= number("reference");
    }
  }
}

bool joined(const std::string& name) {
  return name == "reference" || name.rfind("divider.", 0) == 0;
}

using LeftOut = bool (*)(const plant::PartNumber&);

void draw_some(StandParams& params, const BoardDescription& board, int stage, std::uint64_t seed,
               LeftOut left_out) {
  std::map<std::string, double> drawn;
  for (const plant::PartNumber& part : plant::esc_stand_numbers()) {
    const std::string name = part.name;
    if (left_out(part) || (!part.of_nominal && stated(params, name))) continue;
    const std::string stream = "part." + std::to_string(params.esc.motor) + "." + name;
    const auto copy = plant::draw(part, params.tolerance, seed, stream);
    if (!copy) continue;
    double value = *copy;
    params.drawn.push_back({name, value, part.unit});
    drawn[name] = value;
    if (part.of_nominal) value = nominal(params, board, stage, name) * (1.0 + value);
    if (double* beside = number_beside_the_stage(params, name)) {
      *beside = value;
    } else if (!joined(name)) {
      params.stage[name] = value;
    }
  }
  join_numbers(drawn, params.stage);
}

// What a vehicle's table has of each motor is drawn there; around its motors is one air; its instruments are others.
bool is_the_vehicles(const plant::PartNumber& part) {
  const auto each = plant::each_motors_numbers();
  const std::string name = part.name, group = part.group;
  return group == "instruments" || name == "ambient" ||
         std::any_of(each.begin(), each.end(), [&](const auto& its) { return name == its.name; });
}

// What the vehicle's file states of the sense is that part's, and no copy's.
void state_shunt(const plant::CurrentShuntParams& shunt, StageParams& stage) {
  const plant::CurrentShuntParams own;
  if (shunt.gain_tolerance == own.gain_tolerance) stage.erase("shunt.gain");
  if (shunt.gain_error != own.gain_error) {
    stage.erase("shunt.gain");
    stage["shunt.gain_error"] = shunt.gain_error;
  }
  if (shunt.offset_low_A == shunt.offset_high_A) stage["shunt.offset"] = shunt.offset_low_A;
  if (shunt.noise_A != own.noise_A) stage["shunt.noise"] = shunt.noise_A;
}

}  // namespace

void draw_parts(StandParams& params, const BoardDescription& board, std::uint64_t seed) {
  draw_some(params, board, params.esc.motor, seed, [](const plant::PartNumber&) { return false; });
}

VehiclesEsc draw_esc(const VehiclesEscParams& params, const BoardDescription& board, int stage,
                     std::uint64_t seed) {
  StandParams alone;
  alone.esc.motor = params.motor;
  alone.stage = stage_of(params.shaft, params.shunt);
  state_shunt(params.shunt, alone.stage);
  const auto of_class = [&](const char* group) {
    const auto chosen = params.tolerance.find(group);
    return chosen == params.tolerance.end() ? plant::ToleranceClass::none : chosen->second;
  };
  for (const char* group : plant::esc_stand_groups()) {
    const std::string name = group;
    alone.tolerance[name] = of_class(name == "clock"                     ? "clock"
                                     : name == "motor" || name == "heat" ? "motors"
                                                                         : "escs");
  }
  draw_some(alone, board, stage, seed, is_the_vehicles);
  for (DrawnPart& part : alone.drawn) {
    part.name = "esc " + std::to_string(params.motor) + " " + part.name;
  }
  return {std::move(alone.stage), alone.hse_error, alone.hsi_error, std::move(alone.drawn)};
}

Result<Done> set_parts(BoardDescription& board, const StandParams& params) {
  board.hse_error += params.hse_error;
  board.hsi_error += params.hsi_error;
  return set_stage(board, params.esc.motor, params.stage);
}

Result<Done> set_esc(BoardDescription& board, int stage, const VehiclesEsc& esc) {
  board.hse_error += esc.hse_error;
  board.hsi_error += esc.hsi_error;
  return set_stage(board, stage, esc.stage);
}

}  // namespace whirl::stand
