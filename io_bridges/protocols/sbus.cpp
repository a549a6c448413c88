#include "io_bridges/protocols/sbus.hpp"

#include <algorithm>
#include <cmath>

namespace whirl::io {
namespace {

constexpr unsigned kBits = 11;
constexpr double kLow = 172.0, kHigh = 1811.0;

}  // namespace

std::array<std::uint8_t, kSbusBytes> encode(const SbusFrame& frame) {
  std::array<std::uint8_t, kSbusBytes> bytes{};
  bytes[0] = core::receiver::kSbusStart;
  for (unsigned channel = 0; channel < frame.channels.size(); ++channel) {
    for (unsigned bit = 0; bit < kBits; ++bit) {
      const unsigned at = channel * kBits + bit;
      if ((frame.channels[channel] >> bit & 1) == 0) continue;
      bytes[1 + at / 8] = static_cast<std::uint8_t>(bytes[1 + at / 8] | 1u << at % 8);
    }
  }
  bytes[23] = frame.flags;
  bytes[24] = core::receiver::kSbusEnd;
  return bytes;
}

std::uint16_t sbus_of_travel(double travel) {
  const double value = std::lround(0.5 * (kLow + kHigh) + 0.5 * (kHigh - kLow) * travel);
  return static_cast<std::uint16_t>(std::clamp(value, 0.0, 2047.0));
}

}  // namespace whirl::io
