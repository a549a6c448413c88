// Firmware images that write random values into random registers, by seed: Thumb code put straight
// into an ELF file, no compiler needed.
//
//   Code      some hundred accesses in a loop, of all widths, to the blocks of one part, its NVIC and
//             SysTick; a little sleep, a little idling, now and then a stack somewhere else
//   Handlers  interrupts count, and all are masked at every 256th, so that the loop goes on; a fault
//             steps over its instruction
//   Good      QEMU runs it and says what it does in words: it runs, faults, locks up or is reset
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace whirl {

struct FuzzImage {
  std::string mcu;
  std::vector<std::uint8_t> elf;
};

// Even seeds are for an STM32F405, odd ones for an STM32F103.
FuzzImage fuzz_image(std::uint64_t seed);

}  // namespace whirl
