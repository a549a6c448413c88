// The power stage: six switches, the PWM that drives the upper ones, and the free-running time base
// of commutation.
//
//   Wiring   upper switches TIM4 CH1..3 on PB6, PB7, PB8; lower ones PA7, PB0, PB1
//   PWM      20 kHz on the upper switch of the pattern; the lower one is on throughout; in the off
//            time the current freewheels through the lower diode of the upper phase
//   Sampling TIM4 CH4 rises shortly before the end of the on time and triggers the converters
#pragma once
#include <cstdint>

#include "firmware/esc/core/commutation.hpp"

namespace fw::esc::bridge {

inline constexpr std::uint32_t kTimer_Hz = 72'000'000;
inline constexpr std::uint32_t kPwm_Hz = 20'000;
inline constexpr std::uint32_t kPeriod = kTimer_Hz / kPwm_Hz;  // counts
inline constexpr std::uint32_t kSample_before_end = 90;        // 1.25 us: both samples fit
inline constexpr std::uint32_t kShortest_on = 120;  // counts that leave room for a sample

void start();                         // everything off
void off();                           // all six switches off: the motor coasts
void let_go();                        // likewise, and the duty stays as it is
void apply(std::uint8_t step);        // 0..5, see commutation.hpp
void set_duty(std::uint32_t counts);  // of kPeriod; taken over at the next PWM period
std::uint32_t duty();
std::uint32_t counts_of(float share);
std::uint8_t floating_phase(std::uint8_t step);  // 0..2

Ticks now();
void interrupt_at(Ticks at);  // TIM2's handler runs then, or at once if that is past
void acknowledge_interrupt();

}  // namespace fw::esc::bridge
