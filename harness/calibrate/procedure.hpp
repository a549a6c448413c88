// The measurements of a calibration, one after another, on a bench that has just been powered.
//
//   Rest     motor off: the current sense's offset
//   Still    rising duties in still air: sense's gain, motor, static maps
//   Transients  duty in steps and as a sinusoid: back-EMF against resistance, inertia
//   Blown    several duties in each wind: the rotor's power and thrust over inflow
//   Updraft  how much less than in still air the rotor takes: power alone does not tell up from down
//   Zero     wind raised until the load cell reads no thrust, and points about it: profile power
//   Source   [Bangura 2017, 3.3, 3.4, 5.3.3]
#pragma once
#include <functional>

#include "harness/calibrate/bench.hpp"
#include "harness/calibrate/data.hpp"
#include "harness/calibrate/setup.hpp"

namespace whirl::calibrate {

using Teller = std::function<void(const std::string& words)>;  // what is being measured

Result<StandData> measure_all(Bench& bench, const Setup& setup, const Teller& tell);

// Types the lines ("set kt 0.01"), `identified 1` and `save`; then the ESC must say that it is
// calibrated. Pre: the motor stands.
Result<Done> store(Bench& bench, const std::vector<std::string>& lines);

}  // namespace whirl::calibrate
