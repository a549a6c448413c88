// whirl standin: a real image on a virtual board, an ESC's on its thrust stand, its lines on pseudo-terminals and its I2C
// behind an MCP2221A that this kernel's uhid plays, so that a bench finds what it would find of metal.
//
//   Folder    serial, instruments: links to the lines; bench.lua: the bench that hangs on them, phrase included
//   Exit code 0: ended by a signal, or the time was over; 2: bad input, no /dev/uhid
//   CAN       of a board with a can_port: joined to an interface of SocketCAN
//   Flies     of a flight controller's board with its nodes on CAN the board alone stands here (bare_board.hpp): its
//             radio's line is on a pseudo-terminal, and the bench plays sensors and ESCs over the interface
//   Left out  the wires' own noise
#pragma once
#include <string>

#include "harness/cli/stand_in_request.hpp"

namespace whirl {

int stand_in_command(const cli::StandInRequest& request, const std::string& root);

}  // namespace whirl
