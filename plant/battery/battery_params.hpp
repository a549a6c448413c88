// A pack as seen from its terminals: open-circuit curve over charge, series resistance, two
// relaxation times, all resistances over charge and temperature. A laboratory supply is a pack of
// constant voltage that never empties.
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace whirl::plant {

struct OpenCircuitPoint {
  double depth_of_discharge = 0.0;  // 0 full, 1 empty
  double voltage_V = 0.0;
};

// What all three resistances are multiplied by; straight between the points.
struct ResistanceOverDepth {
  double depth_of_discharge = 0.0;
  double factor = 1.0;
};
struct ResistanceOverTemperature {
  double temperature_K = 298.15;
  double factor = 1.0;
};

struct BatteryParams {
  std::vector<OpenCircuitPoint> open_circuit;  // falling, depth first at 0, last at 1
  double capacity_C = 2.2 * 3600.0;
  double series_resistance_ohm = 0.030;
  double relaxation_resistance_ohm = 0.0;
  double relaxation_time_s = 1.0;
  double slow_relaxation_resistance_ohm = 0.0;
  double slow_relaxation_time_s = 100.0;
  std::vector<ResistanceOverDepth> resistance_over_depth;              // none: 1
  std::vector<ResistanceOverTemperature> resistance_over_temperature;  // none: 1
  double temperature_K = 298.15;                                       // of the cells, all the time
  double initial_depth_of_discharge = 0.0;
};

BatteryParams lipo_4s_2200();
BatteryParams lab_supply(double voltage_V, double resistance_ohm);

Result<Done> validate(const BatteryParams& params, const std::string& place);

}  // namespace whirl::plant
