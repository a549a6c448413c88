#include "plant/sensors/load_cell.hpp"

#include <cmath>

namespace whirl::plant {

LoadCell::LoadCell(const LoadCellParams& p, std::uint64_t seed, const std::string& name)
    : params_(p),
      channels_{Channel{.gain = 1.0 + p.thrust_gain_error,
                        .offset = p.thrust_offset_N,
                        .noise = WhiteNoise(p.thrust_noise_N, seed, name + ".thrust")},
                Channel{.gain = 1.0 + p.torque_gain_error,
                        .offset = p.torque_offset_Nm,
                        .noise = WhiteNoise(p.torque_noise_Nm, seed, name + ".torque")}} {}

double LoadCell::Channel::read(double x, double rate_dt, double dt_s) {
  const double fade = std::exp(-rate_dt), gap1 = first - x, gap2 = second - x;
  first = x + fade * gap1;
  second = x + fade * (gap2 + rate_dt * gap1);
  return gain * second + offset + noise.sample(dt_s);
}

LoadReading LoadCell::sample(double dt_s, const LoadReading& truth) {
  const double rate_dt = 6.283185307179586 * params_.bandwidth_Hz * dt_s;
  return {channels_[0].read(truth.thrust_N, rate_dt, dt_s),
          channels_[1].read(truth.torque_Nm, rate_dt, dt_s)};
}

}  // namespace whirl::plant
