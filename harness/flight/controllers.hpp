// The motor controllers that a vehicle can have; the first one is who has nothing said.
//
//   Adding  one line here, NAME, and NAME.cpp beside it, which defines ControllerType NAME_type()
#pragma once
#include "harness/flight/motor_controller.hpp"

// A macro because it names a file's function and calls it, and one line is to do both.
#define WHIRL_MOTOR_CONTROLLERS(TYPE) TYPE(native_esc)

namespace whirl::flight {

#define WHIRL_DECLARE(name) ControllerType name##_type();
WHIRL_MOTOR_CONTROLLERS(WHIRL_DECLARE)
#undef WHIRL_DECLARE

const ControllerTypes& controller_types();
// Pre: one of the types has that name (a vehicle's file is held to it).
const ControllerType& type_named(const std::string& name, const ControllerTypes& types);
std::vector<std::string> names_of(const ControllerTypes& types);

}  // namespace whirl::flight
