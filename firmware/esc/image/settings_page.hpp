// The page of settings as it stands in flash: what the image reads and saves, and what is flashed beside the
// image to make one controller differ from the next (motor_number.cpp).
//
//   Format  magic, size, payload, CRC-32 over all before it; padding is 0 and takes part
#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "firmware/crc32.hpp"
#include "firmware/esc/image/settings.hpp"

namespace fw::esc::settings {

struct Stored {
  std::uint32_t magic;
  std::uint32_t size;
  Settings settings;
  std::uint32_t crc;
};
static_assert(sizeof(Stored) % 4 == 0 && sizeof(Stored) <= 1024);
inline constexpr std::uint32_t kMagic = 0x5E77'0002;

// As save() leaves it, before anything runs. Value by value, because padding has none.
class PageBytes {
 public:
  static constexpr std::size_t kSize = sizeof(Stored);

  constexpr explicit PageBytes(const Settings& settings) {
    constexpr std::size_t kSettings = offsetof(Stored, settings);
    constexpr std::size_t kCalibration = kSettings + offsetof(Settings, calibration);
    const Calibration& c = settings.calibration;
    put(offsetof(Stored, magic), kMagic);
    put(offsetof(Stored, size), static_cast<std::uint32_t>(kSize));
    put(kSettings + offsetof(Settings, motor_number), settings.motor_number);
    put(kCalibration + offsetof(Calibration, motor), c.motor);
    put(kCalibration + offsetof(Calibration, losses), c.losses);
    put(kCalibration + offsetof(Calibration, power), c.power);
    put(kCalibration + offsetof(Calibration, free_air), c.free_air);
    put(kCalibration + offsetof(Calibration, sense), c.sense);
    put(kCalibration + offsetof(Calibration, shared_power), c.shared_power);
    put(kCalibration + offsetof(Calibration, rotor), c.rotor);
    put(kCalibration + offsetof(Calibration, arming_voltage_V), c.arming_voltage_V);
    put(kCalibration + offsetof(Calibration, mode), c.mode);
    put(kCalibration + offsetof(Calibration, identified), c.identified);
    std::uint32_t crc = kCrc32Start;
    for (std::size_t i = 0; i < offsetof(Stored, crc); ++i) crc = crc32_add(crc, bytes_[i]);
    put(offsetof(Stored, crc), ~crc);
  }
  constexpr const std::array<std::uint8_t, kSize>& bytes() const { return bytes_; }
  // A value that was added to Settings and not here leaves more than the padding of an end.
  constexpr bool whole() const { return placed_ <= kSize && kSize - placed_ < alignof(Stored); }

 private:
  template <typename T>
  constexpr void put(std::size_t at, const T& value) {
    const auto bytes = std::bit_cast<std::array<std::uint8_t, sizeof(T)>>(value);
    for (const std::uint8_t byte : bytes) bytes_[at++] = byte;
    placed_ += sizeof(T);
  }
  std::array<std::uint8_t, kSize> bytes_{};
  std::size_t placed_ = 0;
};

}  // namespace fw::esc::settings
