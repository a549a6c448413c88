// USART1 for people and for the stand: lines in, text and frames out. DMA moves the bytes, so that no
// character is lost while the control tick runs and none costs an interrupt.
//
//   In    channel 5, a ring that the main loop reads at least once per tick; 92 bytes come in a tick
//   Out   channel 4, a ring sent in pieces; the end of one starts the next
#pragma once
#include <cstdint>
#include <string_view>

namespace fw::esc::serial {

inline constexpr std::uint32_t kBaud = 921'600;

void start();
// A complete line without its end, or empty. The view holds until the next call.
std::string_view take_line();
bool put(std::string_view bytes);  // as a whole; false: no room, nothing was queued

}  // namespace fw::esc::serial
