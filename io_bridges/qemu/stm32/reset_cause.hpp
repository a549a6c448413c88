// Why the part was reset; RCC_CSR shows it to the firmware.
#pragma once
#include <cstdint>

namespace whirl::stm32 {

enum class ResetCause : std::uint8_t {
  power_on,
  pin,
  software,  // SYSRESETREQ
  independent_watchdog,
  window_watchdog,
  low_power,
};

}  // namespace whirl::stm32
