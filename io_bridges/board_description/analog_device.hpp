// The devices of a board that do nothing but bring a level to an analog pin, their `bus`.
#pragma once
#include "io_bridges/board_description/board_description.hpp"

namespace whirl {

inline bool puts_a_level(const BoardDevice& device) {
  return device.type == "battery_sense" || device.type == "current_sense" || device.type == "volts";
}

}  // namespace whirl
