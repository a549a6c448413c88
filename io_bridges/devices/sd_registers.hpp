// The registers of an SD card as it sends them: CSD, CID, OCR, SCR.
//
//   Source  SD Physical Layer Simplified Specification 4.10, chapter 5; SanDisk SD Card Product Manual
//           rev 2.2, chapter 3, for version 1 of the CSD
//   Error   the tests hold golden CSDs and CIDs with their CRCs (tests/sd_registers_test.cpp)
#pragma once
#include <array>
#include <cstdint>

namespace whirl::io::sd {

inline constexpr std::int64_t kBlock_bytes = 512;

using Register = std::array<std::uint8_t, 16>;  // bit 127 first, with CRC7 and the end bit

// Capacity comes in units: 512 KiB for high capacity; 256 KiB for standard, up to 1 GiB.
inline constexpr std::int64_t kUnit_high_bytes = 512 * 1024, kUnit_standard_bytes = 256 * 1024;
inline constexpr std::int64_t kMost_standard_bytes = 1024LL * 1024 * 1024;

// Pre: size is a whole number of units, and within what the kind of card can have.
Register csd(bool high_capacity, std::int64_t size_bytes);

struct Identity {
  std::uint8_t manufacturer = 0x03;
  std::array<char, 2> application{'S', 'D'};
  std::array<char, 5> product{'W', 'H', 'I', 'R', 'L'};
  std::uint8_t revision_bcd = 0x10;
  std::uint32_t serial = 0;
  int year = 2012, month = 6;  // of manufacture, 2000..2255, 1..12
};
Register cid(const Identity& identity);

inline constexpr std::uint32_t kOcr_voltages = 0x00FF8000;  // 2.7 to 3.6 V
inline constexpr std::uint32_t kOcr_powered = 1u << 31, kOcr_high_capacity = 1u << 30;

// SCR: version 2.00 of the specification, erased bits read 0, 1-bit and 4-bit bus.
inline constexpr std::array<std::uint8_t, 8> kScr{0x02, 0x05, 0, 0, 0, 0, 0, 0};

}  // namespace whirl::io::sd
