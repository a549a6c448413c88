// What identifies a DroneCAN data type on the bus, and how its signature comes from its definition.
//
//   Signature  CRC-64/WE over the normalised definition (full name, then a line per field, as the DSDL
//              specification orders); of types with nested ones it is more: those are taken from the fact sheet
//   Error      signatures of published types come out (tests/dronecan_codec_test.cpp)
//   Source     dronecan/DSDL @b4653c7a
#pragma once
#include <cstdint>
#include <string_view>

namespace whirl::io::dronecan {

enum class Kind : std::uint8_t { message, request, response };

struct DataType {
  Kind kind = Kind::message;
  std::uint16_t id = 0;
  std::uint64_t signature = 0;
  std::uint16_t most_bytes = 0;
  const char* name = "";
};

constexpr std::uint64_t signature_of(std::string_view normalised) {
  std::uint64_t crc = ~0ull;
  for (const char c : normalised) {
    crc ^= static_cast<std::uint64_t>(static_cast<std::uint8_t>(c)) << 56;
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc >> 63) != 0 ? crc << 1 ^ 0x42F0E1EBA9EA3693 : crc << 1;
    }
  }
  return ~crc;
}

}  // namespace whirl::io::dronecan
