// USART1's input (PB7, J1's pin 7), where a receiver's SBUS comes in: 100000 baud, 8E2. An interrupt hands each byte
// on as it ends, for a frame begins behind a pause, and each byte's parity counts.
//
//   Line     inverted on copper, which this UART cannot undo: an inverter stands before the pin, in the
//            cable where the board has none. Open, the line is held idle
//   Load     1800 bytes a second from a frame each 14 ms; none where no receiver hangs there
//   Source   RM0090, 30.3 (M with PCE: nine bits, the ninth is the parity), 30.6
#pragma once
#include <cstdint>

namespace fw::hal {

void start_receiver_uart();

}  // namespace fw::hal

namespace fw {
// Supplied by the application; called from the interrupt. error: parity, framing, noise or overrun.
void receiver_byte(std::uint8_t byte, bool error);
}  // namespace fw
