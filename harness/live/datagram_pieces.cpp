#include "harness/live/datagram_pieces.hpp"

#include <algorithm>

namespace whirl::live {
namespace {

constexpr std::size_t kLongestOther = 64;

// Of the frame that begins here; 0: none does.
std::size_t frame_length(std::span<const std::uint8_t> bytes) {
  constexpr std::uint8_t kV2 = 0xFD, kV1 = 0xFE, kSigned = 0x01;
  if (bytes.size() < 3) return 0;
  std::size_t length = 0;
  if (bytes[0] == kV2) length = 12u + bytes[1] + ((bytes[2] & kSigned) != 0 ? 13u : 0u);
  if (bytes[0] == kV1) length = 8u + bytes[1];
  return length <= bytes.size() ? length : 0;
}

}  // namespace

std::vector<std::span<const std::uint8_t>> pieces_of(std::span<const std::uint8_t> datagram) {
  std::vector<std::span<const std::uint8_t>> pieces;
  while (!datagram.empty()) {
    std::size_t length = frame_length(datagram);
    if (length == 0) {
      length = 1;
      while (length < std::min(kLongestOther, datagram.size()) &&
             frame_length(datagram.subspan(length)) == 0) {
        ++length;
      }
    }
    pieces.push_back(datagram.first(length));
    datagram = datagram.subspan(length);
  }
  return pieces;
}

}  // namespace whirl::live
