// A board as a Lua file: which MCU, which crystal, which parts hang on which bus.
//
//   Pins    named pins: a resistor (pull), the line of an I2C bus that is soldered to it (bus)
//   Params  a device's own parameters pass through: texts that are quantities become SI numbers
//   Errors  bad_input, with file and line
#pragma once
#include <string>

#include "base/result.hpp"
#include "io_bridges/board_description/board_description.hpp"

namespace whirl {

using Board = BoardDescription;

Result<Board> read_board(const std::string& path);

}  // namespace whirl
