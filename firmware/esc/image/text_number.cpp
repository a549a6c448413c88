#include "firmware/esc/image/text_number.hpp"

#include <bit>
#include <cstdint>

namespace fw::esc {
namespace {

constexpr std::uint64_t kTop = std::uint64_t{1} << 63;

struct Wide {  // mantissa * 2^exponent, the mantissa's highest bit set unless it is 0
  std::uint64_t mantissa = 0;
  int exponent = 0;

  void normalise() {
    if (mantissa == 0) return;
    for (; (mantissa & kTop) == 0; mantissa <<= 1) --exponent;
  }
  void times_ten() {
    mantissa = (mantissa >> 4) * 10;
    exponent += 4;
    normalise();
  }
  void by_ten() {
    mantissa /= 10;
    normalise();
  }
};

// Rounded to nearest. False: beyond a float's range; what is too small becomes 0.
bool to_float(const Wide& wide, float& value) {
  if (wide.mantissa == 0) return value = 0.0f, true;
  int exponent = wide.exponent + 63;  // of the highest bit
  std::uint64_t bits = (wide.mantissa >> 40) + ((wide.mantissa >> 39) & 1);
  if (bits >> 24 != 0) {
    bits >>= 1;
    ++exponent;
  }
  if (exponent < -126) return value = 0.0f, true;
  if (exponent > 127) return false;
  value = std::bit_cast<float>(static_cast<std::uint32_t>(exponent + 127) << 23 |
                               (static_cast<std::uint32_t>(bits) & 0x7F'FFFF));
  return true;
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// [-]digits, at most four of them.
bool parse_exponent(std::string_view text, int& value) {
  const bool negative = !text.empty() && text.front() == '-';
  if (!text.empty() && (negative || text.front() == '+')) text.remove_prefix(1);
  if (text.empty() || text.size() > 4) return false;
  value = 0;
  for (const char c : text) {
    if (!is_digit(c)) return false;
    value = 10 * value + (c - '0');
  }
  if (negative) value = -value;
  return true;
}

struct Decimal {  // digits * 10^scale
  std::uint64_t digits = 0;
  int scale = 0;
  std::size_t length = 0;  // of the text that was read; 0: no digit
};

Decimal read_digits(std::string_view text) {
  Decimal read;
  bool fraction = false, any = false;
  std::size_t i = 0;
  for (; i < text.size(); ++i) {
    if (text[i] == '.' && !fraction) {
      fraction = true;
      continue;
    }
    if (!is_digit(text[i])) break;
    any = true;
    const bool room = read.digits < 100'000'000'000'000'000u;
    if (room) read.digits = 10 * read.digits + static_cast<std::uint64_t>(text[i] - '0');
    read.scale += (room ? 0 : 1) - (fraction ? 1 : 0);
  }
  read.length = any ? i : 0;
  return read;
}

}  // namespace

bool parse_number(std::string_view text, float& value) {
  const bool negative = !text.empty() && text.front() == '-';
  if (negative) text.remove_prefix(1);
  Decimal read = read_digits(text);
  if (read.length == 0) return false;
  text.remove_prefix(read.length);
  if (!text.empty()) {
    int exponent = 0;
    if (text.front() != 'e' && text.front() != 'E') return false;
    text.remove_prefix(1);
    if (!parse_exponent(text, exponent)) return false;
    read.scale += exponent;
  }
  if (read.scale > 60 || read.scale < -80) return false;
  Wide wide{read.digits, 0};
  wide.normalise();
  for (; read.scale > 0; --read.scale) wide.times_ten();
  for (; read.scale < 0; ++read.scale) wide.by_ten();
  float size = 0.0f;
  if (!to_float(wide, size)) return false;
  value = negative ? -size : size;
  return true;
}

std::string_view write_number(float value, NumberText& text) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t biased = (bits >> 23) & 0xFF, fraction = bits & 0x7F'FFFF;
  if (biased == 0xFF) return fraction != 0 ? "nan" : (bits >> 31) != 0 ? "-inf" : "inf";
  std::size_t n = 0;
  if ((bits >> 31) != 0) text[n++] = '-';
  if (biased == 0) {  // zero, and what is too small to matter
    text[n++] = '0';
    return {text.data(), n};
  }
  Wide wide{fraction | 0x80'0000u, static_cast<int>(biased) - 150};
  wide.normalise();
  // Brought to [2^29, 2^33) by tens, then to exactly nine digits.
  int scale = 0;
  for (; wide.exponent + 63 > 31; ++scale) wide.by_ten();
  for (; wide.exponent + 63 < 29; --scale) wide.times_ten();
  const int shift = -wide.exponent;  // 31..34
  std::uint64_t digits = wide.mantissa >> shift;
  std::uint64_t rest = wide.mantissa & ((std::uint64_t{1} << shift) - 1);
  bool up = (rest >> (shift - 1)) != 0;
  for (; digits >= 1'000'000'000u; ++scale) {
    up = digits % 10 >= 5;
    digits /= 10;
  }
  if (up && ++digits == 1'000'000'000u) {
    digits = 100'000'000u;
    ++scale;
  }
  std::array<char, 9> decimal{};
  for (std::size_t i = decimal.size(); i-- > 0; digits /= 10) {
    decimal[i] = static_cast<char>('0' + digits % 10);
  }
  text[n++] = decimal[0];
  text[n++] = '.';
  for (std::size_t i = 1; i < decimal.size(); ++i) text[n++] = decimal[i];
  int exponent = scale + 8;
  text[n++] = 'e';
  if (exponent < 0) text[n++] = '-';
  if (exponent < 0) exponent = -exponent;
  if (exponent >= 10) text[n++] = static_cast<char>('0' + exponent / 10);
  text[n++] = static_cast<char>('0' + exponent % 10);
  return {text.data(), n};
}

}  // namespace fw::esc
