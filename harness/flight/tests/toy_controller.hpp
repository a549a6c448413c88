// See toy_controller.cpp.
#pragma once
#include "harness/flight/motor_controller.hpp"

namespace whirl::flight {

ControllerType toy_controller_type();

}  // namespace whirl::flight
