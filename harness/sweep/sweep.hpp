// Steady behaviour of a propeller or of a vehicle's drive, over one thing at a time: what a user
// compares with his own motor and propeller before he believes a plan.
//
//   Propeller  over speed (static), axial inflow, advance ratio: thrust, torque, power, figure of merit
//   Vehicle    the same, and over motor voltage: speed, thrust, currents; and its hover point
//   Model      the plant's own rotor and motor, run until they are steady; standard air at sea level.
//              Between pulses the current goes where the vehicle's motor controllers let it in flight
//              (ControllerType::freewheel)
//   Hover      the bus carries all motors and the avionics; the pack has rested, its relaxation is not
//              in the voltage, but is in the time to empty
//   Error      hover's current against the same ESCs in flight within 1 % (tests/sweep_test.cpp)
//   Band       of hover: 90 % of the power that lifts its weight, by the propeller's traits and their discrepancy
//              (blade_fit.hpp), through motor, ESC and pack; what is uncertain of these is not in it, nor that the
//              speed moves with thrust's own error
//   Left out   in the time to empty: climbs, gusts, a reserve, a firmware that lands before
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "harness/flight/flight_params.hpp"
#include "plant/rotor/blade.hpp"
#include "results/charts.hpp"

namespace whirl::sweep {

struct Options {
  double speed_radps = 0.0;  // of the sweeps over inflow and advance; 0: three quarters of the top
  double top_speed_radps = 628;  // 6000 rpm
  double bus_V = 0.0;            // 0: the full pack
  // Of a propeller along its shaft (forward_sweep.hpp). Empty: the measured files' speeds, or three of the top.
  std::vector<double> speeds_radps;
  std::vector<double> advance_ratios = {0.0, 0.2, 0.4};
};

std::vector<results::Chart> propeller_sweep(const std::shared_ptr<const plant::Blade>& blade,
                                            const Options& options);
std::vector<results::Chart> vehicle_sweep(const flight::FlightParams& vehicle,
                                          const Options& options);

// What speaks against its propeller's file, for the terminal and the page.
std::vector<std::string> doubt_lines(const std::vector<std::string>& doubts);

// One motor and propeller on their feed: over voltage, and the propeller.
std::vector<results::Chart> drive_sweep(const flight::FlightParams& drive, const Options& options);

// One point of a vehicle's drive: motor and propeller at a constant mean voltage of the bridge.
struct DrivePoint {
  double voltage_V = 0, speed_radps = 0, thrust_N = 0, torque_Nm = 0;
  double winding_A = 0, bus_A = 0, shaft_W = 0, electrical_W = 0;
  double copper_W = 0, diode_W = 0, no_load_W = 0;
};
DrivePoint drive_point(const flight::FlightParams& vehicle, double voltage_V, double bus_V);
// The voltage at which it lifts thrust_N, by bisection; an Error where no voltage up to bus_V does.
Result<DrivePoint> drive_for_thrust(const flight::FlightParams& vehicle, double thrust_N,
                                    double bus_V);

// The voltage at which it turns so fast; an Error where none up to bus_V does.
Result<DrivePoint> drive_at_speed(const flight::FlightParams& drive, double speed_radps,
                                  double bus_V);

// What the propeller's 90 % band leaves open of hover: its power at that thrust, at the mean speed.
struct HoverBand {
  double least_A = 0.0, most_A = 0.0;  // infinite: it does not hover
  double shortest_s = 0.0, longest_s = 0.0;
};
struct HoverPoint {
  DrivePoint each;  // motor
  double bus_V = 0.0, total_A = 0.0;
  double until_empty_s = 0.0;     // from full
  std::optional<HoverBand> band;  // where the propeller has one
};
// bus_V: 0 for the full pack's under that load, or what a supply holds.
Result<HoverPoint> hover_point(const flight::FlightParams& vehicle, double bus_V);

}  // namespace whirl::sweep
