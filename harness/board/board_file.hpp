// A board as a Lua file: which MCU, which crystal, which parts hang on which bus.
//
//   Gives   the description with SI numbers as JSON for the board's process, and what the harness
//           itself must know: devices by name, watched functions by number
//   Pins    named pins: a resistor (pull), the line of an I2C bus that is soldered to it (bus)
//   Params  a device's own parameters pass through: texts that are quantities become SI numbers
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace whirl {

struct BoardDevice {
  std::string name;  // "imu", "esc1"
  std::string type;  // "mpu6000", "esc_i2c"
  std::string bus;   // "spi1", "i2c3", "usart2"
  int address = -1;  // I2C
  int motor = 0;     // of an ESC; 0: none
  std::string cs, interrupt;
  std::string json;  // the whole entry
};

struct Board {
  std::string file, name, mcu;
  double hse_Hz = 0, lse_Hz = 0;
  double hse_start_s = 2e-3;            // of the crystal
  double hsi_error = 0, hse_error = 0;  // of their frequency, as a share
  std::string boot_image;      // of a boot loader that is flashed beside the image; empty: none
  std::uint32_t start = 0;     // of the vector table at reset; 0: the start of flash
  int ns_per_instruction = 0;  // 0: time passes by the cycles of the core
  // Of a time that code takes, as a share of it; a fixed rate states none.
  double timing_accuracy() const { return ns_per_instruction == 0 ? 0.1 : 0.0; }
  std::vector<BoardDevice> devices;
  std::vector<std::string> watch;
  std::string pins_json;

  std::string timing_profile() const;  // what the report says of time on this board
  const BoardDevice* find(const std::string& device) const;
  int number(const std::string& device) const;  // place in the list; -1: not there
  int watch_number(const std::string& function) const;
};

Result<Board> read_board(const std::string& path);

struct BoardRun {  // what differs from run to run
  std::string image;
  std::uint64_t seed = 1;
  std::int64_t sync_ns = 1'000'000;
  bool gdb = false;
  int gdb_port = 0;
};
// The text that the board's process reads.
std::string board_json(const Board& board, const BoardRun& run);

}  // namespace whirl
