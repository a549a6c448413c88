// What joins two boards in a device's place is one wire: the ends of it that each of the two gets, with a port for each
// bus of the board that follows.
#pragma once
#include <string>
#include <vector>

#include "io_bridges/board_description/board_description.hpp"

namespace whirl {

struct WirePlace {
  std::string device;                   // of the leader, that the follower takes the place of
  std::string bus;                      // of the follower
  std::string select = {}, ready = {};  // of SPI, the follower's pins
  std::int64_t latency_ns = 0;          // of `ready`; of a UART its shortest character
};

struct WireEnds {
  std::vector<WireEnd> leading, following;
};

// fd: of the wire (io_bridges/link/wire.hpp).
WireEnds wire_ends(const std::vector<WirePlace>& places, int fd);

// Of a UART that speaks no faster: ten bits, at a rate that may be off by 3 %.
std::int64_t shortest_character_ns(double fastest_baud);

}  // namespace whirl
