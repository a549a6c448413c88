// A motor's own file, with the keys of motor.hpp:
//
//   return { kind = "motor", name = "Turnigy D2836/9", kv_rpm_per_V = 950, resistance = "120 mohm", ... }
//   Used by  whirl sweep, and by a vehicle or stand as motor = { file = "../motors/NAME.lua" }
#pragma once
#include <string>

#include "base/result.hpp"
#include "plant/motor/motor_params.hpp"

namespace whirl::catalogue {

struct MotorFile {
  std::string name;
  plant::MotorParams params;
};
Result<MotorFile> read_motor_file(const std::string& path);

}  // namespace whirl::catalogue
