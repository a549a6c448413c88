#include "harness/stand/stage_params.hpp"

#include "base/check.hpp"

namespace whirl::stand {

Result<Done> set_stage(BoardDescription& board, int motor, const StageParams& params) {
  for (BoardDevice& device : board.devices) {
    if (device.type != "power_stage" || device.motor != motor) continue;
    for (const auto& [name, value] : params) {
      // A part's own error takes the place of the tolerance that it would be drawn from, and back.
      if (name == "shunt.gain_error") device.keys.erase("params.shunt.gain");
      if (name == "shunt.gain") device.keys.erase("params.shunt.gain_error");
      WHIRL_CHECK(device.set("params." + name, value), name);
    }
    return Done{};
  }
  return Error{ErrorKind::bad_input, board.name,
               "has no power stage of motor " + std::to_string(motor),
               "a stand needs one: esc32v2 has it"};
}

namespace {

void take(const StageParams& params, const char* name, double& into) {
  if (const auto found = params.find(name); found != params.end()) into = found->second;
}

}  // namespace

plant::MotorParams motor_of(const StageParams& params) {
  plant::MotorParams m;
  take(params, "torque_constant", m.torque_constant_NmpA);
  take(params, "resistance", m.resistance_ohm);
  take(params, "inductance", m.inductance_H);
  take(params, "no_load_current", m.no_load_current_A);
  take(params, "inertia", m.inertia_kgm2);
  return m;
}

plant::CurrentShuntParams shunt_of(const StageParams& params) {
  plant::CurrentShuntParams s;
  take(params, "shunt.gain", s.gain_tolerance);
  take(params, "shunt.warm_up", s.warm_up_A);
  take(params, "shunt.wander", s.wander_A);
  take(params, "shunt.offset", s.offset_low_A);
  take(params, "shunt.gain_error", s.gain_error);
  if (params.contains("shunt.noise")) take(params, "shunt.noise", s.noise_A), s.noise_per_A = 0.0;
  if (params.contains("shunt.gain_error")) s.gain_tolerance = 0.0;
  if (params.contains("shunt.offset")) s.offset_high_A = s.offset_low_A;
  return s;
}

}  // namespace whirl::stand
