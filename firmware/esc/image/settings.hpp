// What the ESC keeps over power-down: its number and its calibration, in the last page of flash.
//
//   Format  magic, version, payload, CRC-32; anything else is refused and defaults are used
//   Save    erases and programs; the core stalls for up to 40 ms, so only while the motor stands
#pragma once
#include <cstdint>

#include "firmware/esc/core/calibration.hpp"

namespace fw::esc {

struct Settings {
  std::uint32_t motor_number = 1;  // 1..4: I2C address 0x28 + n
  Calibration calibration;
};

namespace settings {
inline constexpr std::uint32_t kPage = 0x0801'FC00;
bool load(Settings& settings);        // false: nothing valid there, settings untouched
bool save(const Settings& settings);  // false: the flash refused or reads back differently
}  // namespace settings

}  // namespace fw::esc
