// IEEE 754 half precision, as DroneCAN's float16: to nearest, ties to even.
//
//   Saturation  finite numbers beyond 65504 become +-65504 ("saturated" of the DSDL); infinities and NaN stay
//   Error       every one of the 65536 patterns comes back as itself (tests/dronecan_codec_test.cpp)
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>

namespace whirl::io::dronecan {

constexpr float from_float16(std::uint16_t half) {
  const std::uint32_t sign = static_cast<std::uint32_t>(half & 0x8000) << 16;
  const std::uint32_t exponent = half >> 10 & 0x1F;
  const std::uint32_t mantissa = half & 0x3FF;
  if (exponent == 0x1F) return std::bit_cast<float>(sign | 0x7F800000 | mantissa << 13);
  if (exponent == 0) {  // subnormal: mantissa * 2^-24
    const float size = static_cast<float>(mantissa) * 0x1p-24f;
    return sign != 0 ? -size : size;
  }
  return std::bit_cast<float>(sign | (exponent + 112) << 23 | mantissa << 13);
}

constexpr std::uint16_t to_float16(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const auto sign = static_cast<std::uint16_t>(bits >> 16 & 0x8000);
  const std::uint32_t size = bits & 0x7FFFFFFF;
  if (size > 0x7F800000) return static_cast<std::uint16_t>(sign | 0x7E00 | (size >> 13 & 0x3FF));
  if (size == 0x7F800000) return static_cast<std::uint16_t>(sign | 0x7C00);
  if (size >= 0x477FF000) return static_cast<std::uint16_t>(sign | 0x7BFF);  // would round to 65536
  if (size < 0x38800000) {  // below 2^-14: a whole number of 2^-24
    const std::uint32_t exponent = size >> 23;
    if (exponent < 102) return sign;  // below half of the smallest
    const std::uint32_t mantissa = (size & 0x7FFFFF) | 0x800000;
    const std::uint32_t shift = 126 - exponent;
    const std::uint32_t half = 1u << (shift - 1);
    const std::uint32_t odd = mantissa >> shift & 1;
    return static_cast<std::uint16_t>(sign | (mantissa + half - 1 + odd) >> shift);
  }
  const std::uint32_t odd = size >> 13 & 1;
  return static_cast<std::uint16_t>(sign | (size - (112u << 23) + 0xFFF + odd) >> 13);
}

}  // namespace whirl::io::dronecan
