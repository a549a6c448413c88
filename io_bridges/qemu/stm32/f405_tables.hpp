// The STM32F405 as tables: which signal reaches which pin, which request which DMA stream, where a
// block sits and which RCC bits belong to it.
//
//   Source  STM32F405xx datasheet table 9 (alternate functions), RM0090 tables 1 (memory map),
//           42 and 43 (DMA requests), chapter 7 (RCC)
#pragma once
#include <cstdint>
#include <span>

namespace whirl::stm32 {

struct AlternateFunction {
  char port;
  std::uint8_t pin, af;
  const char* signal;
};
struct DmaRoute {
  std::uint8_t controller, stream, channel;
  const char* request;
};
// RCC offsets of the enable register; the reset register lies 0x20 below it.
struct BlockClock {
  const char* name;
  std::uint32_t base;
  std::uint32_t enable;
  std::uint32_t mask;
  std::uint32_t reset_mask;
};

std::span<const AlternateFunction> f405_alternate_functions();
std::span<const DmaRoute> f405_dma_routes();
std::span<const BlockClock> f405_block_clocks();

}  // namespace whirl::stm32
