// What a board process is told at its start: the board's description as JSON with SI numbers.
//
//   Keys    board, mcu, hse_Hz, hse_start_ns, lse_Hz, hsi_error, hse_error, image, boot_image, start,
//           ns_per_instruction, seed, sync_ns, gdb_port,
//           devices[] {name, type, bus, cs, int, address, motor, baud, params{}},
//           pins[] {name, pin, pull, bus}, watch[] (function names)
//   Errors  bad_input, with the key that is wrong
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"

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
  std::string pull;  // "up", "down": a resistor of the board
  std::string bus;   // "i2c1.scl": soldered to that line
};

struct BoardConfig {
  std::string board, mcu, image;
  std::string boot_image;   // of a boot loader that lies in flash beside the image; empty: none
  std::uint32_t start = 0;  // address of the vector table at reset; 0: the start of flash
  double hse_Hz = 0.0, lse_Hz = 0.0;
  double hsi_error = 0.0, hse_error = 0.0;  // as a share of the frequency: +-0.05, +-0.001
  std::int64_t hse_start_ns = 2'000'000;
  std::int64_t ns_per_instruction = 0;  // 0: by the cycles that the core takes
  std::uint64_t seed = 1;
  std::int64_t sync_ns = 1'000'000;
  int gdb_port = 0;
  std::vector<DeviceConfig> devices;
  std::vector<PinConfig> pins;
  std::vector<std::string> watch;
};

Result<BoardConfig> parse_board(std::string_view json_text);

}  // namespace whirl::board
