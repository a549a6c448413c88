// The converters: floating phase and bus voltage on ADC1, the shunt on ADC2, at once and in step with
// the PWM; one interrupt per PWM period.
//
//   Scale   phases and bus through 1.5/11.5 dividers at 3.3 V and 12 bits: 6.177 mV per count;
//           shunt 0.5 mohm x 50.9: 31.66 mA per count
#pragma once
#include <cstdint>

namespace fw::esc::sampling {

struct Sample {
  int floating, bus, shunt;  // counts
};
struct Phases {
  int a, b, c, bus;  // counts
};

void start();
// From the next trigger: one phase with bus and shunt, or all three phases with the bus.
void watch_floating(std::uint8_t phase);
void watch_phases();
void select_floating(std::uint8_t phase);  // another one, while one is watched
Sample read();                             // in the interrupt: reads and clears
Phases take_phases();                      // what watch_phases() asked for

}  // namespace fw::esc::sampling
