// The pilot's sticks, from a sum signal on PA10 or SBUS on USART1: both are listened to, and flight/receiver_choice.hpp
// says which of them counts.
#pragma once
#include "firmware/flight/flight.hpp"

namespace fw {

void start_sticks();  // after start_time_base()
// Hands on a frame that has come since the last call. More often than frames come.
void read_sticks(Flight& flight);

}  // namespace fw
