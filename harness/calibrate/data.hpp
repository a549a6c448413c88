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
  double esc_A_half_width = 0.0;  // 95 % interval of the mean esc_A
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
  std::vector<SteadyPoint> updraft;
  std::vector<Sample> steps, sinusoid;
};

struct Range {
  double low = 0.0, high = 0.0;
  bool holds(double x) const { return x > low && x < high; }
};

// Speeds of the points in wind, and the points there, in wind and in still air: where the motor is
// loaded enough for its winding's current to have no gaps, and Reynolds number is about the same.
Range working_radps(const StandData& data);
std::vector<SteadyPoint> working_points(const StandData& data);
std::vector<SteadyPoint> working_still(const StandData& data);

// One figure of each point or sample.
template <typename T, typename F>
std::vector<double> column(const std::vector<T>& points, F value) {
  std::vector<double> out;
  out.reserve(points.size());
  for (const T& p : points) out.push_back(value(p));
  return out;
}

}  // namespace whirl::calibrate
