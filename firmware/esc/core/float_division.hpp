// Division of floats by the core's integer divider, bit by bit what IEEE 754 asks (round to nearest,
// ties to even). The library's goes bit by bit and takes three times as long on a Cortex-M3.
//
//   Method  a quotient of 24 bits in three digits of 8: each is one UDIV of a remainder
//   Valid   both operands normal and the quotient too; else quotient() says so and the library divides
#pragma once
#include <cstdint>

namespace fw::esc {

struct Quotient {
  std::uint32_t bits;
  bool valid;
};

// Operands and result as their bits.
inline Quotient quotient(std::uint32_t a, std::uint32_t b) {
  constexpr std::uint32_t kSign = 0x80000000u, kFraction = 0x007FFFFFu, kOne = 0x00800000u;
  constexpr std::uint32_t kBias = 127, kMost = 254;
  const std::uint32_t a_exponent = (a >> 23) & 0xFF, b_exponent = (b >> 23) & 0xFF;
  if (a_exponent - 1 >= kMost || b_exponent - 1 >= kMost) return {0, false};
  std::uint32_t dividend = (a & kFraction) | kOne;
  const std::uint32_t divisor = (b & kFraction) | kOne;
  std::uint32_t exponent = a_exponent - b_exponent + kBias;
  if (dividend < divisor) {
    dividend <<= 1;
    --exponent;
  }
  if (exponent - 1 >= kMost) return {0, false};
  // 1 <= dividend / divisor < 2: the first digit has its highest bit set.
  std::uint32_t remainder = dividend << 7;
  std::uint32_t digits = remainder / divisor;
  remainder = (remainder - digits * divisor) << 8;
  std::uint32_t digit = remainder / divisor;
  digits = digits << 8 | digit;
  remainder = (remainder - digit * divisor) << 8;
  digit = remainder / divisor;
  digits = digits << 8 | digit;
  remainder = (remainder - digit * divisor) << 1;
  if (remainder > divisor || (remainder == divisor && (digits & 1) != 0)) ++digits;
  // A carry out of the fraction is one more in the exponent; 254 + 1 would be infinity, and is.
  return {((a ^ b) & kSign) | ((exponent << 23) + (digits - kOne)), true};
}

}  // namespace fw::esc
