// The one clock of all figures: DWT_CYCCNT, cycles of the core since its start, modulo 2^32. The kernels
// in assembly read the same register (kernel.hpp).
#pragma once
#include <cstdint>

#include "firmware/hal/core_registers.hpp"

namespace fw::timing {

namespace dwt {
using DEMCR = hw::Reg32<0xE000'EDFC>;
using CTRL = hw::Reg32<0xE000'1000>;
using CYCCNT = hw::Reg32<0xE000'1004>;
inline constexpr std::uint32_t kTrcena = hw::bit(24), kCyccntena = hw::bit(0);
}  // namespace dwt

inline void start_cycle_counter() {
  dwt::DEMCR::set(dwt::kTrcena);
  dwt::CYCCNT::write(0);
  dwt::CTRL::set(dwt::kCyccntena);
}

inline std::uint32_t cycles() {
  return dwt::CYCCNT::read();
}

}  // namespace fw::timing
