// Motors and avionics on one pack: the bus voltage and all currents of a sub-step agree.
//
//   Method  Newton's steps on the mean bus voltage of the sub-step, whose slope is known but for the
//           shaft's part; two rounds are usual, the last residual is reported
//   Error   residual under 1e-8 V, books of motors + pack close (tests/power_bus_test.cpp)
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
  BatteryBooks battery{};
};

// `drives[i].bus_V` is filled in (and is the first guess next time); `books[i]` receives the motors' books.
BusDraw step_bus(std::span<AveragedMotor> motors, std::span<Drive> drives,
                 std::span<const ShaftLoad> loads, double avionics_A, Battery& battery, double dt_s,
                 std::span<MotorBooks> books);

}  // namespace whirl::plant
