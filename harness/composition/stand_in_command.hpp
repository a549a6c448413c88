// whirl standin: an ESC's real image on a virtual board and thrust stand, its lines on pseudo-terminals and its I2C
// behind an MCP2221A that this kernel's uhid plays, so that a bench finds what it would find of metal.
//
//   Folder    serial, instruments: links to the lines; bench.lua: the bench that hangs on them, phrase included
//   Exit code 0: ended by a signal, or the time was over; 2: bad input, no /dev/uhid
//   CAN       of a board with a can_port: joined to an interface of SocketCAN
//   Left out  boards that fly; the wires' own noise
#pragma once
#include <string>

#include "harness/cli/stand_in_request.hpp"

namespace whirl {

int stand_in_command(const cli::StandInRequest& request, const std::string& root);

}  // namespace whirl
