// One entry of a board file's `devices`: read key by key as its type says (io_bridges/rack).
//
//   Errors  kept by the table, with file and line: an unknown type or key (with the list of those
//           there are), a missing key, a value of another kind or dimension, or out of range
#pragma once
#include "harness/lua/table.hpp"
#include "io_bridges/board_description/board_description.hpp"
#include "io_bridges/rack/check_board.hpp"

namespace whirl {

BoardDevice read_device(const lua::Table& entry, const rack::DeviceTypes& types);

// Says in the file what check_board.hpp found; `entry` is that of the device.
void refuse(const lua::Table& entry, const rack::BoardComplaint& complaint);

}  // namespace whirl
