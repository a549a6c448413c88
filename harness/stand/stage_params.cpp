#include "harness/stand/stage_params.hpp"

#include <nlohmann/json.hpp>

#include "base/rpm.hpp"
#include "plant/motor/motor_params.hpp"

namespace whirl::stand {
namespace {

// An amount of its own, or a share more or less than the plant's.
void read_amount(const lua::Table& t, const char* key, Dimension dimension, double base_SI,
                 StageParams& params) {
  if (!t.has(key)) return;
  if (t.kind(key) == lua::Kind::text) {
    const auto share = parse_quantity_as(t.text(key), Dimension::ratio, "");
    if (share) {
      if (!lua::between(-0.95, 10.0).holds(share.value())) {
        t.refuse(key, t.text(key) + " is outside -95 %..1000 %");
      }
      params[key] = base_SI * (1.0 + share.value());
      return;
    }
  }
  params[key] = t.quantity(key, dimension, lua::above(0.0));
}

void read_motor(const lua::Table& t, StageParams& params) {
  const plant::MotorParams base;
  read_amount(t, "inertia", Dimension::inertia, base.inertia_kgm2, params);
  read_amount(t, "resistance", Dimension::resistance, base.resistance_ohm, params);
  read_amount(t, "inductance", Dimension::inductance, base.inductance_H, params);
  read_amount(t, "no_load_current", Dimension::current, base.no_load_current_A, params);
  if (t.flag_or("swap_wires", false)) params["swap_wires"] = 1.0;
  if (t.has("kv_rpm_per_V")) {
    const double kv = t.number("kv_rpm_per_V", lua::between(10.0, 1e5));
    if (kv > 0.0) params["torque_constant"] = torque_constant_NmpA_of(kv);
  }
}

void read_shunt(const lua::Table& t, StageParams& params) {
  if (t.has("gain")) {
    params["shunt.gain_error"] = t.quantity("gain", Dimension::ratio, lua::between(-0.5, 0.5));
  }
  for (const char* key : {"offset", "noise", "warm_up", "wander"}) {
    if (!t.has(key)) continue;
    params[std::string("shunt.") + key] =
        t.quantity(key, Dimension::current, lua::between(0.0, 20.0));
  }
}

}  // namespace

StageParams read_stage(const lua::Table& stand) {
  StageParams params;
  if (stand.has("motor")) read_motor(stand.table("motor"), params);
  if (stand.has("shunt")) read_shunt(stand.table("shunt"), params);
  return params;
}

Result<std::string> with_stage(const std::string& board_json, int motor,
                               const StageParams& params) {
  nlohmann::json board = nlohmann::json::parse(board_json);
  for (nlohmann::json& device : board["devices"]) {
    if (device["type"] != "power_stage" || device.value("motor", 0) != motor) continue;
    for (const auto& [name, value] : params) device["params"][name] = value;
    return board.dump(1);
  }
  return Error{ErrorKind::bad_input, board.value("board", std::string("board")),
               "has no power stage of motor " + std::to_string(motor),
               "a stand needs one: esc32v2 has it"};
}

}  // namespace whirl::stand
