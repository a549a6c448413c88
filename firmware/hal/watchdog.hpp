// Independent watchdog: about 0.25 s on its own oscillator (32 kHz nominal, 17 to 47 kHz).
#pragma once
#include "firmware/hal/registers.hpp"

namespace fw::hal {

inline void start_watchdog() {
  constexpr std::uint32_t kDivideBy16 = 2, kReload = 500;  // 500 / 2 kHz
  hw::IWDG::KR::write(hw::IWDG::START);
  hw::IWDG::KR::write(hw::IWDG::UNLOCK);
  hw::IWDG::PR::write(kDivideBy16);
  hw::IWDG::RLR::write(kReload);
  hw::IWDG::KR::write(hw::IWDG::RELOAD);
}

inline void feed_watchdog() {
  hw::IWDG::KR::write(hw::IWDG::RELOAD);
}

}  // namespace fw::hal
