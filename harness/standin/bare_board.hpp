// A board as metal lies on a bench: without the parts that the bench plays to it.
//
//   Pod's host    is left out; its line, or its bus, is there for whoever plays it
//   Nodes on CAN  of the world are left out; in their place the bus has a can_port
//   Radio         its UART ends at a serial line, bytes as they are
//   Receiver      with SBUS likewise, 8E2
//   GPS           on a UART likewise, at whatever rate the UART has: no copper between two that differ
//   The rest      (memories, a receiver's sum signal, what is on other buses) stays on the board
#pragma once
#include "io_bridges/board_description/board_description.hpp"

namespace whirl {

BoardDescription bare_board(BoardDescription board);

}  // namespace whirl
