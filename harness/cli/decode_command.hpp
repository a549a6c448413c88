// whirl decode: what a logic analyser's capture says of a board's buses, as rows of bus.csv.
#pragma once
#include <string>

#include "harness/cli/composition.hpp"

namespace whirl::cli {

struct DecodeOptions {
  std::string capture, board;  // the board's name or file: whose devices and pins the channels name
  std::string rate = "50 MHz";  // at which a .vcd is looked at
};

// Rows on standard output; on standard error what could not be read, frame by frame, and what there was in all.
// 0: all was read; 1: frames could not be; 2: no capture, or wires that the board has not.
int decode_command(const DecodeOptions& options, const Composition& composition);

}  // namespace whirl::cli
