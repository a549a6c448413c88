// Continuous turbulence, Dryden form: three gust velocities and three gust rates.
//
//   Axes    along the mean relative wind (u), across it and level (v), down (w)
//   Units   SI outside; the scale lengths are the standard's, converted from feet
//   Valid   low altitude, under 300 m; an airspeed below 1 m/s counts as 1 m/s (a hovering vehicle in
//           still air would otherwise see the same gust for ever)
//   Source  [MIL8785C, 3.7.2, 3.7.3]
//   Method  each filter's exact discrete equivalent for white noise, so the step does not matter
//   Error   spectra within 10 % over two decades (tests/dryden_test.cpp)
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "base/random.hpp"
#include "plant/air/air_params.hpp"

namespace whirl::plant {

struct DrydenScales {
  double length_uv_m = 0.0, length_w_m = 0.0, sigma_uv_mps = 0.0, sigma_w_mps = 0.0;
};
DrydenScales dryden_scales(double height_m, double wind_at_6m_mps);

struct Gust {
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();  // u, v, w
  Eigen::Vector3d rate_radps = Eigen::Vector3d::Zero();    // p, q, r
};

class Dryden {
 public:
  Dryden(const DrydenParams& params, std::uint64_t seed);
  Gust step(double airspeed_mps, double height_m, double dt_s);

 private:
  struct Pole {  // two equal poles in a row, driven by one noise
    double first = 0.0, second = 0.0;
    void step(double rate, double dt_s, RandomStream& noise);
  };
  DrydenParams params_;
  std::vector<RandomStream> noise_;
  std::array<Pole, 3> velocity_;
  double roll_ = 0.0, pitch_lag_ = 0.0, yaw_lag_ = 0.0;
};

}  // namespace whirl::plant
