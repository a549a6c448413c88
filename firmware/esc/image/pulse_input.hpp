// The receiver's pulses on PA8: TIM1 in PWM-input mode, read by the control tick.
//
//   Timing   1 MHz; edges shorter than 14 us do not pass the filter; no interrupt
#pragma once
#include <cstdint>

namespace fw::esc::pulse_input {

struct Pulse {
  std::uint32_t width_us = 0, period_us = 0;
};

void start();
// What ended at a rising edge since the last call. Two of them in a millisecond: a period of 0.
bool read(Pulse& pulse);

}  // namespace fw::esc::pulse_input
