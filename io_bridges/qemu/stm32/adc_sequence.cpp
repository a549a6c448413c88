// What a converter's registers say of its sequences: which channels, how long for each.
#include <algorithm>

#include "io_bridges/qemu/stm32/adc.hpp"
#include "io_bridges/qemu/stm32/adc_registers.hpp"
#include "io_bridges/qemu/stm32/register_access.hpp"

namespace whirl::stm32 {

using namespace adc;

namespace {

constexpr int kSamplingF4[8] = {6, 30, 56, 112, 168, 224, 288, 960};  // half clocks
constexpr int kSamplingF1[8] = {3, 15, 27, 57, 83, 111, 143, 479};

}  // namespace

unsigned Adc::regular_length() const {
  return (cr1_ & SCAN) != 0 ? field(sqr_[0], 20, 4) + 1 : 1;
}

unsigned Adc::injected_length() const {
  return (cr1_ & SCAN) != 0 ? field(jsqr_, 20, 2) + 1 : 1;
}

unsigned Adc::regular_channel(unsigned rank) const {
  if (rank < 6) return field(sqr_[2], 5 * rank, 5);
  if (rank < 12) return field(sqr_[1], 5 * (rank - 6), 5);
  return field(sqr_[0], 5 * (rank - 12), 5);
}

// With JL = n the group is the last n + 1 of JSQ1..JSQ4.
unsigned Adc::injected_channel(unsigned rank) const {
  return field(jsqr_, 5 * (3 - field(jsqr_, 20, 2) + rank), 5);
}

std::int64_t Adc::sampling_half_clocks(unsigned channel) const {
  const std::uint32_t selected = channel >= 10
                                     ? field(smpr_[0], 3 * (std::min(channel, 18u) - 10), 3)
                                     : field(smpr_[1], 3 * channel, 3);
  return f4() ? kSamplingF4[selected] : kSamplingF1[selected];
}

unsigned Adc::bits() const {
  return f4() ? 12 - 2 * field(cr1_, 24, 2) : 12;
}

std::int64_t Adc::conversion_half_clocks() const {
  return f4() ? 2 * bits() : 25;
}

}  // namespace whirl::stm32
