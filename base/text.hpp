// Any bytes as text that others can read: firmware, plans and file names may hold what they like.
//
//   Legal   well-formed UTF-8 of the characters that XML 1.0 knows: no control characters but tab, line
//           feed and carriage return, no surrogates, no U+FFFE and U+FFFF
//   Else    each byte that is not part of such a character is shown as \xNN
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace whirl {

std::string legal_text(std::string_view bytes);      // for files
std::string printable_line(std::string_view bytes);  // for terminals: no control character at all

std::string hex(std::uint32_t value);                                  // "0x0800012c"
void add_hex(std::span<const std::uint8_t> bytes, std::string& text);  // "6A00", behind it

}  // namespace whirl
