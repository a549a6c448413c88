// A voltage on its way to an ADC pin: through a resistor into a capacitor at the pin, with noise.
//
//   In      a level that holds until the next one, as messages tell it
//   Out     the pin's voltage at any later time: the capacitor's, exactly, and white noise on top, a
//           draw for each sample; clamped to the rails by the pin's diodes
//   Valid   the capacitor is much larger than the converter's own (0.1 uF to some pF): sampling does not
//           move it
//   Left out leakage, the resistor's own heat, ripple of the motors' PWM beyond the messages' 1 kHz
#pragma once
#include <cstdint>
#include <string>

#include "base/random.hpp"
#include "io_bridges/devices/event_queue.hpp"

namespace whirl::rack {

class SenseLine {
 public:
  struct Params {
    double time_constant_s = 0.0;
    double noise_V = 0.0;   // RMS at the pin
    double supply_V = 3.3;  // of the microcontroller: the pin's diodes conduct beyond
    std::uint64_t seed = 1;
    std::string name = "sense";
  };

  explicit SenseLine(const Params& params);

  void set_V(double level_V, io::Nanoseconds now);
  double sample_V(io::Nanoseconds now);

 private:
  void advance_to(io::Nanoseconds now);

  Params params_;
  RandomStream noise_;
  double level_V_ = 0.0, capacitor_V_ = 0.0;
  io::Nanoseconds time_ns_ = 0;
  bool settled_ = false;  // the board was powered long before the run
};

// A resistor of that tolerance: evenly between its bounds, by seed and name.
double drawn_resistance_ohm(double nominal_ohm, double tolerance, std::uint64_t seed,
                            const std::string& name);

}  // namespace whirl::rack
