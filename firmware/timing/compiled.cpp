#include "firmware/timing/compiled.hpp"

#include <bit>

namespace fw::timing {
namespace {

struct Coefficients {
  float b0, b1, b2, a1, a2;
};
// A low-pass at a tenth of the sampling rate.
constexpr Coefficients kLowPass{0.0675f, 0.135f, 0.0675f, -1.143f, 0.4128f};

constexpr std::int32_t fixed(float value) {
  return static_cast<std::int32_t>(value * 65536.0f);
}

}  // namespace

// Transposed direct form II.
__attribute__((noinline)) void biquad_float(std::uint32_t* ram) {
  const auto* in = std::bit_cast<const float*>(ram);
  auto* out = std::bit_cast<float*>(ram + kSamples);
  float s1 = 0.0f, s2 = 0.0f;
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    const float x = in[i], y = kLowPass.b0 * x + s1;
    s1 = kLowPass.b1 * x - kLowPass.a1 * y + s2;
    s2 = kLowPass.b2 * x - kLowPass.a2 * y;
    out[i] = y;
  }
}

__attribute__((noinline)) void biquad_fixed(std::uint32_t* ram) {
  const auto* in = std::bit_cast<const std::int32_t*>(ram);
  auto* out = std::bit_cast<std::int32_t*>(ram + kSamples);
  std::int64_t s1 = 0, s2 = 0;
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    const std::int64_t x = in[i];
    const auto y = static_cast<std::int32_t>((fixed(kLowPass.b0) * x + s1) >> 16);
    s1 = fixed(kLowPass.b1) * x - static_cast<std::int64_t>(fixed(kLowPass.a1)) * y + s2;
    s2 = fixed(kLowPass.b2) * x - static_cast<std::int64_t>(fixed(kLowPass.a2)) * y;
    out[i] = y;
  }
}

}  // namespace fw::timing
