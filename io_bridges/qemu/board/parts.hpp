// The microcontrollers that the virtual board can carry, and what in QEMU they are built on.
//
//   Source  RM0090 tables 1 and 5, section 39 (F405); DM00037051 (sizes of the RG variant);
//           RM0008 section 3 and 31.6.1 (F103 of medium density)
//   Adding  a part is one line in parts.cpp and a ChipModel (see chip_factory.hpp)
#pragma once
#include <cstdint>
#include <string_view>

namespace whirl::board {

struct MemoryBlock {
  std::uint32_t base = 0;
  std::uint32_t size = 0;
};

struct Part {
  std::string_view mcu;           // as in board descriptions
  std::string_view qemu_machine;  // gives the core, the NVIC and SRAM at 0x20000000
  MemoryBlock flash;
  MemoryBlock machine_flash;  // what the machine has; the rest beyond `flash` is barred
  MemoryBlock sram;
  MemoryBlock machine_sram;  // likewise; smaller than `sram`: the board brings its own
  MemoryBlock ccm;           // size 0: none
  MemoryBlock system_rom;    // boot loader, OTP, identity, option bytes
  std::uint32_t otp_base, uid_base, flash_size_base;
  std::uint32_t idcode;  // DBGMCU_IDCODE
  int priority_bits;     // NVIC
  int interrupts;        // lines, at most as many as the machine's NVIC has
  double sysclk_maximum_Hz;
  std::uint16_t elf_machine;  // EM_ARM
};

// Null: unknown.
const Part* find_part(std::string_view mcu);

}  // namespace whirl::board
