// The microcontrollers that the virtual board can carry, and what in QEMU they are built on.
//
//   Source  RM0090 2.3, 3.3, 38.6, 39 (F405); RM0008 3.3, 30 and 31.6, PM0075 (F103, medium
//           density); data sheets for the sizes of the RG and CB variants
//   Common  four priority bits in the NVIC
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
  std::string_view mcu;              // as in board descriptions
  std::string_view qemu_machine;     // gives the core and the NVIC; must not ignore bus faults
  MemoryBlock flash, machine_flash;  // what the machine has beyond the part's is barred
  MemoryBlock sram, machine_sram;
  MemoryBlock ccm;         // size 0: none
  MemoryBlock system_rom;  // boot loader, OTP, identity, option bytes
  std::uint32_t uid_base, flash_size_base;
  std::uint32_t idcode;  // DBGMCU_IDCODE
  int interrupts;        // lines into the NVIC
  double sysclk_maximum_Hz;
  std::uint16_t elf_machine;  // EM_ARM
  bool is_m4;                 // Cortex-M4 with FPU, else M3
  bool oscillators = true;    // has HSI and HSE
};

// Null: unknown.
const Part* find_part(std::string_view mcu);

}  // namespace whirl::board
