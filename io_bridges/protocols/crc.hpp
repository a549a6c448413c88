// The checksums of our protocols, as published in the catalogue of CRC algorithms.
//
//   crc7    CRC-7/MMC: poly 0x09, init 0, not reflected (commands and registers of SD cards)
//   crc8    CRC-8/SMBUS: poly 0x07, init 0, not reflected (ESC set-points and status)
//   crc16   CRC-16/MCRF4XX: poly 0x1021 reflected, init 0xFFFF, no final xor (MAVLink)
//   crc16_xmodem  CRC-16/XMODEM: poly 0x1021, init 0, not reflected (data blocks of SD cards)
//   Error   all give the catalogue's check values over "123456789" (tests/crc_test.cpp)
#pragma once
#include <cstdint>
#include <span>

#include "io_bridges/devices/core/crc8.hpp"

namespace whirl::io {

using core::crc8_add;

constexpr std::uint16_t crc16_add(std::uint16_t crc, std::uint8_t byte) {
  crc = static_cast<std::uint16_t>(crc ^ byte);
  for (int bit = 0; bit < 8; ++bit) {
    crc = static_cast<std::uint16_t>((crc & 1) != 0 ? (crc >> 1) ^ 0x8408 : crc >> 1);
  }
  return crc;
}

constexpr std::uint8_t crc7(std::span<const std::uint8_t> bytes) {
  std::uint8_t crc = 0;  // kept in the upper seven bits
  for (const std::uint8_t byte : bytes) {
    crc = static_cast<std::uint8_t>(crc ^ byte);
    for (int bit = 0; bit < 8; ++bit) {
      crc = static_cast<std::uint8_t>((crc & 0x80) != 0 ? (crc << 1) ^ 0x12 : crc << 1);
    }
  }
  return static_cast<std::uint8_t>(crc >> 1);
}

constexpr std::uint16_t crc16_xmodem(std::span<const std::uint8_t> bytes) {
  std::uint16_t crc = 0;
  for (const std::uint8_t byte : bytes) {
    crc = static_cast<std::uint16_t>(crc ^ byte << 8);
    for (int bit = 0; bit < 8; ++bit) {
      crc = static_cast<std::uint16_t>((crc & 0x8000) != 0 ? (crc << 1) ^ 0x1021 : crc << 1);
    }
  }
  return crc;
}

constexpr std::uint8_t crc8(std::span<const std::uint8_t> bytes, std::uint8_t crc = 0x00) {
  for (const std::uint8_t byte : bytes) crc = crc8_add(crc, byte);
  return crc;
}

constexpr std::uint16_t crc16(std::span<const std::uint8_t> bytes, std::uint16_t crc = 0xFFFF) {
  for (const std::uint8_t byte : bytes) crc = crc16_add(crc, byte);
  return crc;
}

}  // namespace whirl::io
