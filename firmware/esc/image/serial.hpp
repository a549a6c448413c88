// USART1 for people and for the stand: a line in, text out, both by interrupt and ring.
#pragma once
#include <cstdint>
#include <string_view>

namespace fw::esc::serial {

inline constexpr std::uint32_t kBaud = 115'200;

void start();
// A complete line without its end, or empty. The view holds until the next call.
std::string_view take_line();
bool put(std::string_view text);  // false: no room, nothing was queued

}  // namespace fw::esc::serial
