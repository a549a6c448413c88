// Clock tree: the board's crystal (PX4FMU v1: 24 MHz; FW_CRYSTAL_MHZ of another) to SYSCLK 168 MHz, APB1 42 MHz, APB2 84 MHz.
#pragma once
#include <cstdint>

#include "firmware/status.hpp"

namespace fw::hal {

inline constexpr std::uint32_t kPclk1_Hz = 42'000'000, kPclk2_Hz = 84'000'000,
                               kTimclk1_Hz = 84'000'000, kTimclk2_Hz = 168'000'000;

Status start_clocks();  // no_answer: the crystal or the PLL did not start; we then run on 16 MHz

// Why the part came out of reset; reading it clears the flags for the next time.
enum class ResetCause : std::uint8_t { power, pin, software, watchdog, low_power };
ResetCause take_reset_cause();

}  // namespace fw::hal
