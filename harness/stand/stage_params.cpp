#include "harness/stand/stage_params.hpp"

#include <algorithm>
#include <utility>
#include <vector>

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

using plant::CurrentShuntParams;
using plant::MotorParams;

template <typename Params>
using Places = std::vector<std::pair<const char*, double Params::*>>;

const Places<MotorParams> kMotor = {{"torque_constant", &MotorParams::torque_constant_NmpA},
                                    {"resistance", &MotorParams::resistance_ohm},
                                    {"inductance", &MotorParams::inductance_H},
                                    {"no_load_current", &MotorParams::no_load_current_A},
                                    {"inertia", &MotorParams::inertia_kgm2},
                                    {"heat_capacity", &MotorParams::heat_capacity_JpK},
                                    {"bearing_share", &MotorParams::bearing_share}};
const Places<CurrentShuntParams> kDrawn_shunt = {
    {"shunt.gain", &CurrentShuntParams::gain_tolerance},
    {"shunt.warm_up", &CurrentShuntParams::warm_up_A},
    {"shunt.wander", &CurrentShuntParams::wander_A}};
const Places<CurrentShuntParams> kOwn_shunt = {
    {"shunt.offset", &CurrentShuntParams::offset_low_A},
    {"shunt.gain_error", &CurrentShuntParams::gain_error},
    {"shunt.noise", &CurrentShuntParams::noise_A}};

template <typename Params>
void take(const StageParams& from, const Places<Params>& places, Params& into) {
  for (const auto& [name, place] : places) {
    if (const auto found = from.find(name); found != from.end()) into.*place = found->second;
  }
}

template <typename Params>
void put(const Params& from, const Places<Params>& places, StageParams& into) {
  for (const auto& [name, place] : places) into[name] = from.*place;
}

}  // namespace

MotorParams motor_of(const StageParams& params) {
  MotorParams m;
  take(params, kMotor, m);
  m.winding_resistance_ohm = std::min(m.winding_resistance_ohm, m.resistance_ohm);
  return m;
}

CurrentShuntParams shunt_of(const StageParams& params) {
  CurrentShuntParams s;
  take(params, kDrawn_shunt, s);
  take(params, kOwn_shunt, s);
  if (params.contains("shunt.noise")) s.noise_per_A = 0.0;
  if (params.contains("shunt.gain_error")) s.gain_tolerance = 0.0;
  if (params.contains("shunt.offset")) s.offset_high_A = s.offset_low_A;
  return s;
}

StageParams stage_of(const MotorParams& motor, const CurrentShuntParams& shunt) {
  StageParams params;
  put(motor, kMotor, params);
  put(shunt, kDrawn_shunt, params);
  return params;
}

}  // namespace whirl::stand
