// What a flight is made of. What is physics goes to the plant's params, what is belief or protocol to
// the ESC's.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/flight/capture.hpp"
#include "harness/flight/native_esc.hpp"
#include "harness/flight/surroundings.hpp"
#include "harness/world/drawn_part.hpp"
#include "plant/parts/part_number.hpp"
#include "plant/rotor/blade.hpp"
#include "plant/vehicle.hpp"

namespace whirl::plant {
struct FittedBlade;  // fitted_blade.hpp
}

namespace whirl::flight {

// What of the ground the board can hear.
struct BoardEars {
  bool radio = true;                 // a telemetry radio
  bool receiver = true;              // of radio control
  std::uint8_t receivers_board = 0;  // of the run: on which it is
  std::uint8_t radios_board = 0;
};

// A motor controller that is a board of its own: the shaft that its power stage turns is the vehicle's.
struct FarShaft {
  std::uint8_t board = 0;   // of the run
  std::uint16_t stage = 1;  // its power stage's number there
};

// Before a flight each ESC is told what still air takes: still_air.hpp.
struct StillAirRun {
  double thrust_N = 0.0;
  std::int64_t warm_up_ns = 60'000'000'000;
};

struct FlightParams {
  std::string name;
  plant::VehicleParams vehicle;
  std::shared_ptr<const plant::Blade> blade;
  std::shared_ptr<const plant::FittedBlade> fit;  // how sure its propeller is; null: it has no band
  std::vector<std::string> doubts;                // of its propeller's file
  std::string controller = "esc_core";            // of each motor: the name of a ControllerType
  EscParams esc;                                  // esc_core's
  std::optional<StillAirRun> still_air;
  std::vector<fw::esc::Calibration>
      calibrations;                    // by motor, what came of it; empty: esc.calibration
  EscParams esc_of(int motor) const {  // its number: 1, 2...
    EscParams its = esc;
    if (!calibrations.empty())
      its.calibration = calibrations.at(static_cast<std::size_t>(motor) - 1);
    return its;
  }
  CaptureParams capture;
  Surroundings place;
  BoardEars ears;
  // One copy of the hardware (vehicle_parts.hpp): classes by group (plant/parts/vehicle.hpp), none where
  // missing, and what came of it beside the vehicle's own numbers.
  plant::Tolerances tolerance;
  std::map<std::string, double> imu;  // by the board's keys of an mpu6000
  Eigen::Vector3d imu_place_m = Eigen::Vector3d::Zero(), imu_turn_rad = Eigen::Vector3d::Zero();
  double hse_error = 0.0;
  std::vector<DrawnPart> drawn;
  std::vector<FarShaft> far_shafts;          // index: motor number - 1; empty: native controllers
  std::vector<std::uint8_t> sensing_boards;  // of the run, besides the first, with parts that sense
  std::map<int, std::uint8_t> far_escs;      // by motor: the one of these whose parts play its ESC
};

}  // namespace whirl::flight
