// Is a board's list of devices one that can be built? Asked of a board file, with its lines at hand,
// and again by the board's process, whoever described the board to it.
#pragma once
#include <optional>
#include <string>

#include "io_bridges/board_description/board_description.hpp"
#include "io_bridges/rack/device_type.hpp"

namespace whirl::rack {

struct BoardComplaint {
  int device = 0;    // in the board's list
  std::string key;   // may be empty: the device as a whole
  std::string what;  // "unknown type 'toaster'"
  std::string cure;  // "use one of mpu6000, ..."
};

// Type known, all needed keys there, none that the type does not have, each value as it must be.
std::optional<BoardComplaint> check_device(const BoardDevice& device, int number,
                                           const DeviceTypes& types);
// Names, pins, addresses, and what else two devices cannot share. Pre: check_device() of each.
std::optional<BoardComplaint> check_sharing(const BoardDescription& board,
                                            const DeviceTypes& types);

std::string no_key(const DeviceType& type);  // "is no key of a serial"
std::string keys_cure(const DeviceType& type);

}  // namespace whirl::rack
