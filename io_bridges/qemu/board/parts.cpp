#include "io_bridges/qemu/board/parts.hpp"

namespace whirl::board {
namespace {

constexpr std::uint32_t kKiB = 1024;

constexpr Part kF405 = {
    .mcu = "stm32f405rg",
    .qemu_machine = "netduinoplus2",
    .flash = {0x08000000, 1024 * kKiB},
    .machine_flash = {0x08000000, 1024 * kKiB},
    .sram = {0x20000000, 128 * kKiB},
    .machine_sram = {0x20000000, 192 * kKiB},
    .ccm = {0x10000000, 64 * kKiB},
    .system_rom = {0x1FFF0000, 64 * kKiB},
    .uid_base = 0x1FFF7A10,
    .flash_size_base = 0x1FFF7A22,
    .idcode = 0x10076413,  // DEV_ID 0x413, REV_ID 0x1007 (RM0090 38.6.1)
    .interrupts = 82,
    .sysclk_maximum_Hz = 168e6,
    .elf_machine = 40,
    .is_m4 = true,
};

constexpr Part kF103 = {
    .mcu = "stm32f103cb",
    .qemu_machine = "stm32vldiscovery",  // netduino2 swallows bus faults
    .flash = {0x08000000, 128 * kKiB},
    .machine_flash = {0x08000000, 128 * kKiB},
    .sram = {0x20000000, 20 * kKiB},
    .machine_sram = {0x20000000, 8 * kKiB},
    .ccm = {0, 0},
    .system_rom = {0x1FFFF000, 4 * kKiB},
    .uid_base = 0x1FFFF7E8,
    .flash_size_base = 0x1FFFF7E0,
    .idcode = 0x20036410,  // DEV_ID 0x410, REV_ID 0x2003 (RM0008 31.6.1)
    .interrupts = 43,
    .sysclk_maximum_Hz = 72e6,
    .elf_machine = 40,
    .is_m4 = false,
};

// For tests of the virtual board itself (bench_chip.hpp): the F405's core and memories.
constexpr Part bench() {
  Part part = kF405;
  part.mcu = "bench_m4";
  part.oscillators = false;
  return part;
}

constexpr Part kParts[] = {kF405, kF103, bench()};

}  // namespace

const Part* find_part(std::string_view mcu) {
  for (const Part& part : kParts) {
    if (part.mcu == mcu) return &part;
  }
  return nullptr;
}

}  // namespace whirl::board
