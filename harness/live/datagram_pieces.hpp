// Cuts what came in one datagram into what a radio takes as one: MAVLink frames, and runs of other bytes.
//
//   Frame    from 0xFD or 0xFE over its length as its header says; one whose end is beyond the datagram
//            is no frame
//   Other    what lies between them, in pieces of 64 bytes at most. All bytes are in the pieces, in order
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace whirl::live {

std::vector<std::span<const std::uint8_t>> pieces_of(std::span<const std::uint8_t> datagram);

}  // namespace whirl::live
