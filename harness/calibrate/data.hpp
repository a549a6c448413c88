// What the procedures bring home from the stand, and what is concluded from it.
#pragma once
#include <vector>

namespace whirl::calibrate {

// Means over a second or so in which nothing moved.
struct SteadyPoint {
  double wind_mps = 0.0;  // down along the shaft, of the flow generator
  double duty = 0.0;      // as the ESC has it
  double speed_radps = 0.0;
  double esc_A = 0.0, esc_V = 0.0;      // bus current and voltage as the ESC reports them
  double meter_A = 0.0, meter_V = 0.0;  // the stand's own
  double thrust_N = 0.0, torque_Nm = 0.0;
};

struct Sample {  // of a transient
  double t_s = 0.0;
  double duty = 0.0;
  double speed_radps = 0.0;
  double bus_A = 0.0, bus_V = 0.0;  // as the ESC reports them
};

struct StandData {
  double radius_m = 0.0;
  double density_kgpm3 = 1.225;
  std::vector<SteadyPoint> rest;   // motor off
  std::vector<SteadyPoint> still;  // several thrusts, no wind
  std::vector<SteadyPoint> blown;  // several thrusts at several winds
  std::vector<SteadyPoint> zero;   // about zero thrust
  std::vector<Sample> steps, sinusoid;
};

}  // namespace whirl::calibrate
