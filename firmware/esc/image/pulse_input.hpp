// The receiver's pulses on PA8: TIM1 in PWM-input mode, read by the control tick.
//
//   Timing   1 MHz; edges shorter than 14 us do not pass the filter; no interrupt
#pragma once
#include "firmware/esc/core/pulse_edges.hpp"

namespace fw::esc::pulse_input {

void start();
// What ended at a rising edge since the last call, once a millisecond. Not a whole pulse: a period of 0.
bool read(Pulse& pulse);

}  // namespace fw::esc::pulse_input
