// What a board's process is started with, as text: JSON with SI numbers. Written once by the target
// that starts the process, read once by the process.
//
//   Keys    file, board, mcu, hse_Hz, hse_start_ns, lse_Hz, hsi_error, hse_error, boot_image, start,
//           ns_per_instruction, image, seed, gdb_port, folder, node, flashed[],
//           wires[] {device, bus, fd}, devices[] {name, type, place, senses[], any key by its path},
//           pins[] {name, pin, pull, bus, place}, watch[]
//   Exact   what is read back equals what was written, to the last bit of each number; a text that is
//           no UTF-8 (a path may hold any bytes) comes back with other characters in their place
//   Errors  bad_input, with the key that is wrong; a key that is not known is wrong
#pragma once
#include <string>
#include <string_view>

#include "base/result.hpp"
#include "io_bridges/board_description/board_description.hpp"

namespace whirl {

std::string board_text(const BoardStart& start);
Result<BoardStart> read_board_text(std::string_view text);

}  // namespace whirl
