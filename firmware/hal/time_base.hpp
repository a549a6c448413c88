// Time and ticks. TIM2 counts microseconds since power-up. The 1 kHz tick comes from the IMU's
// data-ready; TIM5 watches it, and makes ticks of its own when it stays away.
#pragma once
#include <cstdint>

namespace fw::hal {

void start_time_base();
std::uint32_t now_us();  // wraps after 71 minutes: subtract, never compare

// From the data-ready interrupt: the fallback is due 1.5 ms from here, then every millisecond.
void restart_tick_guard();

}  // namespace fw::hal

namespace fw {
void fallback_tick();  // supplied by the application; called from TIM5's interrupt
}
