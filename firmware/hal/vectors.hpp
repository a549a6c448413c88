// The vector table and the first steps after reset, the same on every Cortex-M.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

extern "C" {
extern std::uint32_t stack_top, data_begin, data_end, data_image, bss_begin, bss_end;
void fw_main();
void reset_handler();
void hard_fault_handler();
void unexpected_interrupt();
}

namespace fw::hal {

using Handler = void (*)();

template <std::size_t kLines>
struct VectorTable {
  const void* stack = &stack_top;
  std::array<Handler, 15> system{};
  std::array<Handler, kLines> irq{};

  constexpr VectorTable() {
    system.fill(unexpected_interrupt);
    irq.fill(unexpected_interrupt);
    system[0] = reset_handler;
    system[2] = hard_fault_handler;
  }
};

// Copies .data and clears .bss. Constructors are not run: the linker script asserts that there are none.
inline void prepare_memory() {
  for (std::uint32_t *to = &data_begin, *from = &data_image; to < &data_end;) *to++ = *from++;
  for (std::uint32_t* to = &bss_begin; to < &bss_end;) *to++ = 0;
}

}  // namespace fw::hal
