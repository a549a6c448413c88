// What a board process is told at its start: the board's description as JSON with SI numbers.
//
//   Keys    board, mcu, hse_Hz, lse_Hz, image, ns_per_instruction, seed, sync_ns, gdb_port,
//           devices[] {name, type, bus, cs, int, address, motor, baud, params{}},
//           pins[] {name, pin}, watch[] (function names), unanswered_limit
//   Errors  bad_input, with the key that is wrong
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "harness/base/result.hpp"

namespace whirl::board {

struct DeviceConfig {
  std::string name, type, bus, cs, interrupt;
  int address = -1;
  int motor = 0;
  double baud = 0.0;
  std::map<std::string, double> params;  // numbers by name; arrays as name.0, name.1, ...
};

struct PinConfig {
  std::string name, pin;
};

struct BoardConfig {
  std::string board, mcu, image;
  double hse_Hz = 0.0, lse_Hz = 0.0;
  std::int64_t ns_per_instruction = 8;
  std::uint64_t seed = 1;
  std::int64_t sync_ns = 1'000'000;
  int gdb_port = 0;
  std::vector<DeviceConfig> devices;
  std::vector<PinConfig> pins;
  std::vector<std::string> watch;
};

Result<BoardConfig> parse_board(std::string_view json_text);

}  // namespace whirl::board
