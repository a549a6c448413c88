// Rising edges on PA10, where a receiver's sum signal comes in: TIM1 channel 3 takes their times, its
// interrupt hands them on.
//
//   Timing   1 MHz, captured in hardware; widened to the 32 bits of now_us() as long as the interrupt
//            comes within 65 ms. Pulses and gaps shorter than 6 us do not pass the filter
//   Source   RM0090, 17.3.5 (input capture), 17.4.7 (filter: fDTS/32, eight samples)
#pragma once
#include <cstdint>

namespace fw::hal {

void start_edge_capture();  // after start_time_base()

}  // namespace fw::hal

namespace fw {
void receiver_edge(
    std::uint32_t edge_us);  // supplied by the application; called from the interrupt
}
