// TIM2 counts microseconds; TIM7 ends the one pulse at a time that the pod makes; TIM5 calls when a sample is due.
#pragma once
#include <cstdint>

namespace fw::pod {

void start_time();
std::uint32_t now_us();  // wraps after 71 minutes
std::int64_t now_ns();   // does not; call it more often than that. In steps of a microsecond
void pulse_timer(std::uint32_t us);  // pulse_over() then; 0: not at all

void alarm_timer(
    std::uint32_t us);  // alarm() then, in place of one that was set before. Pre: us > 0

// Supplied by the application; from interrupts at kPriorityParts.
void pulse_over();
void alarm();

}  // namespace fw::pod
