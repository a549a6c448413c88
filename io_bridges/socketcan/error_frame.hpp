// An error frame of Linux's SocketCAN as what it says.
//
//   Source  include/uapi/linux/can/error.h: the class is in the identifier, details in the eight bytes
#pragma once
#include <array>
#include <cstdint>

#include "io_bridges/socketcan/can_port.hpp"

namespace whirl::io {

CanTrouble parse_error_frame(std::uint32_t id, const std::array<std::uint8_t, 8>& data);
// "bus-off", "nobody acknowledges; error passive, 128 transmit errors"
std::string text_of(const CanTrouble& trouble);

}  // namespace whirl::io
