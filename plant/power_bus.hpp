// Motors and avionics on one pack: the bus voltage and all currents of a sub-step agree.
//
//   Method  secant steps on the mean bus voltage of the sub-step: the charge drawn is nearly affine
//           in it, so two or three rounds agree; the last residual is reported
//   Error   residual under 1e-9 V, books of motors + pack close (tests/power_bus_test.cpp)
#pragma once
#include <array>
#include <span>

#include "plant/battery/battery.hpp"
#include "plant/motor/averaged_motor.hpp"

namespace whirl::plant {

struct BusDraw {  // one sub-step
  double bus_V = 0.0;
  double charge_C = 0.0;
  double residual_V = 0.0;  // how far Ohm's law across the series resistance is missed
};

// `drives[i].bus_V` is filled in; `books[i]` receives the motors' books.
BusDraw step_bus(std::span<AveragedMotor> motors, std::span<Drive> drives,
                 std::span<const ShaftLoad> loads, double avionics_A, Battery& battery, double dt_s,
                 std::span<MotorBooks> books);

}  // namespace whirl::plant
