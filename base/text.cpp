#include "base/text.hpp"

#include <cstdint>
#include <cstdio>

namespace whirl {
namespace {

unsigned byte_at(std::string_view bytes, std::size_t i) {
  return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0;
}

struct Character {
  std::uint32_t code = 0;
  std::size_t size = 0;  // in bytes; 0: this is no UTF-8
};

// Unicode 15, table 3-7: no overlong forms, no surrogates, nothing beyond U+10FFFF.
Character decode(std::string_view bytes) {
  const unsigned first = byte_at(bytes, 0);
  if (first < 0x80) return {first, 1};
  const std::size_t size = first >= 0xC2 && first < 0xE0   ? 2
                           : first >= 0xE0 && first < 0xF0 ? 3
                           : first >= 0xF0 && first < 0xF5 ? 4
                                                           : 0;
  if (size == 0) return {};
  std::uint32_t code = first & (0xFFu >> (size + 1));
  for (std::size_t i = 1; i < size; ++i) {
    const unsigned next = byte_at(bytes, i);
    if ((next & 0xC0u) != 0x80) return {};
    code = code << 6 | (next & 0x3Fu);
  }
  constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  if (code < kLeast[size] || (code >= 0xD800 && code < 0xE000) || code > 0x10FFFF) return {};
  return {code, size};
}

constexpr char kHex[] = "0123456789ABCDEF";

bool is_control(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7F && code < 0xA0);
}

template <typename Allowed>
std::string shown(std::string_view bytes, Allowed allowed) {
  std::string out;
  out.reserve(bytes.size());
  while (!bytes.empty()) {
    const Character c = decode(bytes);
    const std::size_t size = c.size == 0 ? 1 : c.size;
    if (c.size != 0 && allowed(c.code)) {
      out += bytes.substr(0, size);
    } else {
      for (std::size_t i = 0; i < size; ++i) {
        const unsigned byte = byte_at(bytes, i);
        out += {'\\', 'x', kHex[byte >> 4], kHex[byte & 15]};
      }
    }
    bytes.remove_prefix(size);
  }
  return out;
}

}  // namespace

std::string legal_text(std::string_view bytes) {
  return shown(bytes, [](std::uint32_t code) {
    if (code == '\t' || code == '\n' || code == '\r') return true;
    return !is_control(code) && code != 0xFFFE && code != 0xFFFF;
  });
}

std::string printable_line(std::string_view bytes) {
  return shown(bytes, [](std::uint32_t code) {
    // Line and paragraph separator, and what turns the direction of the text around.
    const bool turns = code == 0x2028 || code == 0x2029 || (code >= 0x202A && code <= 0x202E) ||
                       (code >= 0x2066 && code <= 0x2069);
    return !is_control(code) && !turns;
  });
}

std::string hex(std::uint32_t value) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%08x", value);
  return text;
}

void add_hex(std::span<const std::uint8_t> bytes, std::string& text) {
  for (const std::uint8_t byte : bytes) {
    text += kHex[byte >> 4];
    text += kHex[byte & 15];
  }
}

}  // namespace whirl
