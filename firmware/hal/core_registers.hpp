// What every STM32 has at the same place: the core's own registers, the independent watchdog, and how
// a register is read and written.
//
//   Names   registers and bits keep the spelling of the manuals
//   Source  PM0214 and PM0056 (core), RM0090 and RM0008 (IWDG)
//   Rule    the one reinterpret_cast for registers is in RegBlock
#pragma once
#include <cstdint>

namespace fw::hw {

// Registers whose place in their block is only known at run time: one of several mailboxes.
template <std::uint32_t kBase>
struct RegBlock {
  static std::uint32_t read(std::uint32_t offset) { return *at(kBase + offset); }
  static void write(std::uint32_t offset, std::uint32_t value) { *at(kBase + offset) = value; }

  static volatile std::uint32_t* at(std::uint32_t address) {
    return reinterpret_cast<volatile std::uint32_t*>(address);  // NOLINT
  }
};

template <std::uint32_t kAddress>
struct Reg32 {
  static constexpr std::uint32_t address = kAddress;

  static std::uint32_t read() { return *pointer(); }
  static void write(std::uint32_t value) { *pointer() = value; }
  static void set(std::uint32_t bits) { write(read() | bits); }
  static void clear(std::uint32_t bits) { write(read() & ~bits); }
  static void replace(std::uint32_t mask, std::uint32_t bits) { write((read() & ~mask) | bits); }
  static bool has(std::uint32_t bits) { return (read() & bits) == bits; }

 private:
  static volatile std::uint32_t* pointer() { return RegBlock<kAddress>::at(kAddress); }
};

constexpr std::uint32_t bit(unsigned n) {
  return 1u << n;
}

struct SCB {
  using VTOR = Reg32<0xE000'ED08>;
  using AIRCR = Reg32<0xE000'ED0C>;
  using CFSR = Reg32<0xE000'ED28>;
  using HFSR = Reg32<0xE000'ED2C>;
  using MMFAR = Reg32<0xE000'ED34>;
  using BFAR = Reg32<0xE000'ED38>;
  using CPACR = Reg32<0xE000'ED88>;
  static constexpr std::uint32_t SYSRESETREQ = 0x05FA'0004;  // with the key
  static constexpr std::uint32_t CP10_CP11_FULL = 0xFu << 20;
};

struct IWDG {
  static constexpr std::uint32_t base = 0x4000'3000;
  using KR = Reg32<base + 0x00>;
  using PR = Reg32<base + 0x04>;
  using RLR = Reg32<base + 0x08>;
  static constexpr std::uint32_t START = 0xCCCC, RELOAD = 0xAAAA, UNLOCK = 0x5555;
};

template <unsigned kLine>
struct NvicLine {
  using ISER = Reg32<0xE000'E100 + 4 * (kLine / 32)>;
  using IPR = Reg32<0xE000'E400 + 4 * (kLine / 4)>;
  static void enable(std::uint32_t priority) {  // 0 (most urgent) .. 15
    constexpr unsigned shift = 8 * (kLine % 4);
    IPR::replace(0xFFu << shift, priority << (shift + 4));
    ISER::write(bit(kLine % 32));
  }
};

}  // namespace fw::hw
