// The numbers of a calibration by the names that people and files use: `set kt 0.01005` over the
// serial line, calibration = { kt = 0.01005 } in a vehicle file. SI, as Calibration has them.
#pragma once
#include <string_view>

#include "firmware/esc/core/calibration.hpp"

namespace fw::esc {

struct Parameter {
  std::string_view name;
  float& (*in)(Calibration&);
};

inline constexpr Parameter kParameters[] = {
    {"kt", [](Calibration& c) -> float& { return c.motor.Kt_NmpA; }},
    {"resistance", [](Calibration& c) -> float& { return c.motor.resistance_ohm; }},
    {"inductance", [](Calibration& c) -> float& { return c.motor.inductance_H; }},
    {"overlap", [](Calibration& c) -> float& { return c.motor.overlap_ohm_s; }},
    {"no_load", [](Calibration& c) -> float& { return c.motor.no_load_current_A; }},
    {"inertia", [](Calibration& c) -> float& { return c.motor.inertia_kgm2; }},
    {"max_current", [](Calibration& c) -> float& { return c.motor.max_current_A; }},
    {"max_braking", [](Calibration& c) -> float& { return c.motor.max_braking_A; }},
    {"loss_ohm", [](Calibration& c) -> float& { return c.losses.loss_ohm; }},
    {"loss_volt", [](Calibration& c) -> float& { return c.losses.loss_V; }},
    {"loss_share", [](Calibration& c) -> float& { return c.losses.share; }},
    {"loss_emf", [](Calibration& c) -> float& { return c.losses.back_emf_Vs; }},
    {"loss_bus", [](Calibration& c) -> float& { return c.losses.bus_V; }},
    {"drag", [](Calibration& c) -> float& { return c.losses.drag_Nm; }},
    {"a3", [](Calibration& c) -> float& { return c.free_air.a3; }},
    {"a2", [](Calibration& c) -> float& { return c.free_air.a2; }},
    {"a1", [](Calibration& c) -> float& { return c.free_air.a1; }},
    {"q4", [](Calibration& c) -> float& { return c.free_air.q4; }},
    {"q3", [](Calibration& c) -> float& { return c.free_air.q3; }},
    {"q2", [](Calibration& c) -> float& { return c.free_air.q2; }},
    {"gain", [](Calibration& c) -> float& { return c.sense.gain; }},
    {"offset", [](Calibration& c) -> float& { return c.sense.offset_A; }},
    {"warm_up", [](Calibration& c) -> float& { return c.sense.warm_up_A; }},
    {"power_from", [](Calibration& c) -> float& { return c.power.from_radps; }},
    {"power_to", [](Calibration& c) -> float& { return c.power.to_radps; }},
    {"speed_effect", [](Calibration& c) -> float& { return c.power.speed_effect; }},
    {"shared", [](Calibration& c) -> float& { return c.shared_power; }},
    {"c0", [](Calibration& c) -> float& { return c.rotor.c0; }},
    {"c1", [](Calibration& c) -> float& { return c.rotor.c1; }},
    {"c2", [](Calibration& c) -> float& { return c.rotor.c2; }},
    {"c3", [](Calibration& c) -> float& { return c.rotor.c3; }},
    {"c4", [](Calibration& c) -> float& { return c.rotor.c4; }},
    {"d0", [](Calibration& c) -> float& { return c.rotor.d0; }},
    {"d1", [](Calibration& c) -> float& { return c.rotor.d1; }},
    {"arming_voltage", [](Calibration& c) -> float& { return c.arming_voltage_V; }},
};

}  // namespace fw::esc
