// The ESC's current shunt: bus current through an amplifier, with all that is wrong with it.
//
//   Units   A at the input; the reading is in A as well (counts are the converter's matter)
//   Method  one-pole amplifier (it makes PWM pulses their average), gain error fixed for a part, an
//           offset that starts at 4.1 to 4.6 A, wanders after power-up and settles, noise that grows
//           with current
//   Source  [Bangura2017, 3.3.2]: shunt 0.5 mohm, offsets of 8.5e6 to 9.5e6 counts of 483e-9 A
#pragma once
#include <cstdint>
#include <string>

#include "plant/sensors/noise.hpp"

namespace whirl::plant {

struct CurrentShuntParams {
  double pole_Hz = 1000.0;
  double gain_tolerance = 0.10;                    // uniform, drawn once
  double gain_error = 0.0;                         // and one that is known
  double offset_low_A = 4.1, offset_high_A = 4.6;  // uniform, drawn once: where it settles
  double warm_up_A = 0.4;        // standard deviation of the offset's excess at power-up
  double warm_up_time_s = 30.0;  // settled in about 100 s
  double wander_A = 0.01, wander_time_s = 20.0;
  double noise_A = 0.02;      // standard deviation per sample at no current
  double noise_per_A = 0.01;  // and what each ampere adds
};

class CurrentShunt {
 public:
  CurrentShunt(const CurrentShuntParams& params, std::uint64_t seed,
               const std::string& name = "shunt");

  void flow(double bus_A, double dt_s);  // current held over dt: PWM edges or means alike
  double sample_A();                     // what the converter finds now

 private:
  CurrentShuntParams params_;
  GaussMarkov wander_;
  RandomStream noise_;
  double gain_, offset_A_, excess_A_, smooth_A_ = 0.0, t_s_ = 0.0;
};

}  // namespace whirl::plant
