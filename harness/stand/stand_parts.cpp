#include "harness/stand/stand_parts.hpp"

#include "base/check.hpp"
#include "plant/motor/motor_params.hpp"
#include "plant/parts/esc_stand.hpp"
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

double nominal(const StandParams& params, const BoardDescription& board, const std::string& name) {
  if (const auto of_plan = params.stage.find(name); of_plan != params.stage.end()) {
    return of_plan->second;
  }
  for (const BoardDevice& device : board.devices) {
    if (device.type != "power_stage" || device.motor != params.esc.motor) continue;
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

}  // namespace

void draw_parts(StandParams& params, const BoardDescription& board, std::uint64_t seed) {
  std::map<std::string, double> drawn;
  for (const plant::PartNumber& part : plant::esc_stand_numbers()) {
    const std::string name = part.name;
    if (!part.of_nominal && stated(params, name)) continue;
    const std::string stream = "part." + std::to_string(params.esc.motor) + "." + name;
    const auto copy = plant::draw(part, params.tolerance, seed, stream);
    if (!copy) continue;
    double value = *copy;
    params.drawn.push_back({name, value, part.unit});
    drawn[name] = value;
    if (part.of_nominal) value = nominal(params, board, name) * (1.0 + value);
    if (double* beside = number_beside_the_stage(params, name)) {
      *beside = value;
    } else if (!joined(name)) {
      params.stage[name] = value;
    }
  }
  join_numbers(drawn, params.stage);
}

Result<Done> set_parts(BoardDescription& board, const StandParams& params) {
  board.hse_error += params.hse_error;
  board.hsi_error += params.hsi_error;
  return set_stage(board, params.esc.motor, params.stage);
}

}  // namespace whirl::stand
