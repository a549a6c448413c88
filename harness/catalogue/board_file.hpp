// A board as a Lua file: which MCU, which crystal, which parts hang on which bus.
//
//   Pins     named pins: a resistor (pull), the line of an I2C bus that is soldered to it (bus)
//   Devices  by their types, which say what keys there are (io_bridges/rack/devices)
//   Errors   bad_input, with file and line
#pragma once
#include <string>

#include "base/result.hpp"
#include "io_bridges/board_description/board_description.hpp"
#include "io_bridges/rack/devices/table.hpp"

namespace whirl {

Result<BoardDescription> read_board(const std::string& path,
                                    const rack::DeviceTypes& types = rack::device_types());

}  // namespace whirl
