// What a flight is made of. What is physics goes to the plant's params, what is belief or protocol to
// the ESC's.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "harness/flight/capture.hpp"
#include "harness/flight/native_esc.hpp"
#include "harness/flight/surroundings.hpp"
#include "plant/rotor/blade.hpp"
#include "plant/vehicle.hpp"

namespace whirl::flight {

// What of the ground the board can hear.
struct BoardEars {
  bool radio = true;     // a telemetry radio
  bool receiver = true;  // of radio control
};

// A motor controller that is a board of its own: the shaft that its power stage turns is the vehicle's.
struct FarShaft {
  std::uint8_t board = 0;   // of the run
  std::uint16_t stage = 1;  // its power stage's number there
};

struct FlightParams {
  std::string name;
  plant::VehicleParams vehicle;
  std::shared_ptr<const plant::Blade> blade;
  std::string controller = "esc_core";  // of each motor: the name of a ControllerType
  EscParams esc;                        // esc_core's
  CaptureParams capture;
  Surroundings place;
  BoardEars ears;
  std::vector<FarShaft> far_shafts;  // index: motor number - 1; empty: native controllers
};

}  // namespace whirl::flight
