// Code as the compiler makes it, at the images' own -O2: a second-order section, in float and in 16.16.
#pragma once
#include <cstdint>

namespace fw::timing {

inline constexpr std::uint32_t kSamples = 32;
void biquad_float(std::uint32_t* ram);  // 2 * kSamples words of RAM: in, then out
void biquad_fixed(std::uint32_t* ram);

}  // namespace fw::timing
