// A thrust stand's cell: thrust and torque with its own bandwidth, offset, gain and noise.
//
//   Method  second-order low-pass, critically damped, exact for a held input; then gain, offset, noise
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "plant/sensors/noise.hpp"

namespace whirl::plant {

struct LoadCellParams {
  double bandwidth_Hz = 150.0;                           // each of two equal poles
  double thrust_noise_N = 1e-3, torque_noise_Nm = 2e-5;  // densities, per root Hz
  double thrust_offset_N = 0.0, torque_offset_Nm = 0.0;  // of this cell
  double thrust_gain_error = 0.0, torque_gain_error = 0.0;
};

struct LoadReading {
  double thrust_N = 0.0, torque_Nm = 0.0;
};

class LoadCell {
 public:
  LoadCell(const LoadCellParams& params, std::uint64_t seed, const std::string& name = "cell");
  LoadReading sample(double dt_s, const LoadReading& truth);

 private:
  struct Channel {
    double first = 0.0, second = 0.0, gain = 1.0, offset = 0.0;
    WhiteNoise noise;
    double read(double x, double rate_dt, double dt_s);
  };
  LoadCellParams params_;
  std::array<Channel, 2> channels_;
};

}  // namespace whirl::plant
