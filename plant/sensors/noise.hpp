// The noises that sensors are made of; each owns its stream, so adding one disturbs no other.
//
//   Units   of the quantity; densities per square root of Hz
//   Source  [IEEE952, annex C]: white noise of density N has the Allan deviation N / sqrt(tau);
//           flicker noise of instability B has the floor B sqrt(2 ln 2 / pi) = 0.664 B
//   Error   Allan deviations within 10 % (tests/noise_test.cpp, tests/imu_test.cpp)
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "base/random.hpp"

namespace whirl::plant {

class WhiteNoise {  // mean of white noise over the time since the last sample
 public:
  WhiteNoise(double density, std::uint64_t seed, const std::string& name)
      : density_(density), stream_(seed, name) {}
  double sample(double dt_s);

 private:
  double density_;
  RandomStream stream_;
};

class GaussMarkov {  // exponentially correlated, stationary from the start
 public:
  GaussMarkov(double deviation, double time_s, std::uint64_t seed, const std::string& name);
  double step(double dt_s);
  double value() const { return value_; }

 private:
  double deviation_, time_s_;
  RandomStream stream_;
  double value_;
};

// Of second order: two lags of time_s / 2 behind white noise, so its rate has a deviation too,
// 2 deviation / time_s; stationary from the start. time_s is the integral of its autocorrelation.
class SmoothWander {
 public:
  SmoothWander(double deviation, double time_s, std::uint64_t seed, const std::string& name);
  double step(double dt_s);  // exact for any dt_s

 private:
  double deviation_, lag_s_;
  RandomStream stream_;
  double driver_, value_;  // behind the first lag and behind both
};

class Flicker {  // 1/f noise between about 0.3 mHz and 0.3 Hz, as Gauss-Markov terms by decades
 public:
  Flicker(double instability, std::uint64_t seed, const std::string& name);
  double step(double dt_s);

 private:
  std::array<GaussMarkov, 4> terms_;
  double waiting_s_ = 0.0;
};

// One number for a whole run, for example a turn-on bias.
double draw_normal(double deviation, std::uint64_t seed, const std::string& name);
double draw_uniform(double low, double high, std::uint64_t seed, const std::string& name);

}  // namespace whirl::plant
