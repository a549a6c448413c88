// Static pressure as a barometer inside the frame finds it.
//
//   Units   Pa, s
//   Method  true static pressure + rotors' back-pressure (a share of the mean disc loading, so arming
//           makes a step) + a share of the dynamic pressure + drift + white noise, behind one lag
//   Source   no measurement of this frame: a share of 0.1 is 4 Pa (37 cm lower) in the HP quad's hover, of
//           the order that autopilots' thrust compensations hold; either sign is met, by where
//           the part's vent sits
//   Left out temperature, counts and conversion time (the part's device has them)
#pragma once
#include <cstdint>
#include <string>

#include "plant/sensors/noise.hpp"
#include "plant/sensors/truth.hpp"

namespace whirl::plant {

struct BarometerParams {
  double noise_density_Pa = 0.12;  // per root Hz: about 10 cm at 100 Hz
  double drift_Pa = 8.0;           // standard deviation of a slow wander
  double drift_time_s = 600.0;
  double turn_on_bias_Pa = 100.0;  // standard deviation
  double rotor_share = 0.10;       // of thrust over disc area, four discs together
  double disc_area_m2 = 4.0 * 0.050671;
  double wind_share = -0.10;  // of the dynamic pressure
  double lag_s = 0.02;
};

class Barometer {
 public:
  Barometer(const BarometerParams& params, std::uint64_t seed, const std::string& name = "baro");
  double sample_Pa(double dt_s, const Truth& truth);

 private:
  BarometerParams params_;
  WhiteNoise noise_;
  GaussMarkov drift_;
  double bias_Pa_, lagged_Pa_ = 0.0;
  bool started_ = false;
};

}  // namespace whirl::plant
