// A board: its part, its clocks, and what hangs on its pins and buses. The one struct of it: the
// harness fills it from a board file, the board's process builds from it, and a change for one run
// (a stand's own motor, a plan's watches) is a change of this struct.
//
//   Units   SI, and virtual nanoseconds
//   Keys    of a device by their path in the board file ("cs", "params.uplink_loss"); which there
//           are, and in what range, its type says (io_bridges/rack)
//   Text    board_text.hpp: how it gets from one process to the other
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace whirl {

using KeyValue =
    std::variant<bool, double, std::string, std::vector<double>, std::vector<std::string>>;

struct BoardDevice {
  std::string name = {};  // "imu", "esc1"
  std::string type = {};  // "mpu6000", "esc_i2c"
  // What plans and logs speak of. In a board file they are keys like the others.
  std::string bus = {};                  // "spi1", "i2c3", "usart2"; of some types a pin
  int address = -1;                      // I2C; -1: none
  int motor = 0;                         // 0: none
  std::string place = {};                // in the board file, "esc32v2.lua:12"; may be empty
  std::vector<std::string> senses = {};  // of its type: what a fault's `axis` may be, by number
  std::map<std::string, KeyValue, std::less<>> keys = {};  // the others that are given

  // Any key, `bus`, `address` and `motor` too; nothing where it is not given.
  std::optional<KeyValue> value(std::string_view path) const;
  // False: no value for that key can look so (an address that is no whole number).
  bool set(const std::string& path, KeyValue value);
  std::vector<std::string> paths() const;  // of all that are given

  bool operator==(const BoardDevice&) const = default;
};

struct BoardPin {
  std::string name = {}, pin = {};
  std::string pull = {};  // "up", "down": a resistor of the board
  std::string bus = {};   // "i2c1.scl": soldered to that line
  std::string place = {};

  bool operator==(const BoardPin&) const = default;
};

struct BoardDescription {
  std::string file = {};  // where it was read; may be empty
  std::string name = {}, mcu = {};
  double hse_Hz = 0, lse_Hz = 0;          // crystals; 0: not fitted
  std::int64_t hse_start_ns = 2'000'000;  // until the fast one swings
  double hsi_error = 0, hse_error = 0;    // of their frequency, as a share: +-0.05, +-0.001
  std::string boot_image = {};  // of a boot loader that is flashed beside the image; empty: none
  std::uint32_t start = 0;      // of the vector table at reset; 0: the start of flash
  std::int64_t ns_per_instruction = 0;    // 0: time passes by the cycles of the core
  std::vector<BoardDevice> devices = {};  // a device's number is its place here
  std::vector<BoardPin> pins = {};
  std::vector<std::string> watch = {};  // functions and converters

  // Of a time that code takes, as a share of it; a fixed rate states none.
  double timing_accuracy() const { return ns_per_instruction == 0 ? 0.1 : 0.0; }
  std::string timing_profile() const;      // what the report says of time on this board
  std::map<int, double> bauds_Hz() const;  // by UART, of the devices that state theirs
  const BoardDevice* find(const std::string& device) const;
  int number(const std::string& device) const;  // -1: not there
  int watch_number(const std::string& function) const;

  bool operator==(const BoardDescription&) const = default;
};

// One end of a wire to another board. Where this one has the bus's master, the other board takes the
// place of a device; where it has the slave, it follows on a bus. What joins the same two boards has one fd.
// Of CAN the board that arbitrates is as the master's.
struct WireEnd {
  std::string device = {};  // of the master's board; empty: this board follows
  std::string bus = {};     // of the slave's board: "i2c2", "spi1", "can1", "usart6", "dac1"
  int fd = -1;              // io_bridges/link/wire.hpp
  int port = 0;             // of the bus there
  bool shared = false;      // it has other ports as well
  std::string select = {}, ready = {};  // of SPI, the slave's pins; no data-ready: empty
  std::int64_t latency_ns = 0;          // of data-ready, a level; of a UART its shortest character
  bool arbitrates = false;  // of CAN without a device's place: this board does, on its `bus`
  std::string far = {};     // the other board's name there

  bool operator==(const WireEnd&) const = default;
};

struct BoardRun {  // what differs from run to run
  std::string image = {};
  std::vector<std::string> flashed = {};  // ELF files beside the image: settings, calibrations
  std::vector<WireEnd> wires = {};
  std::uint64_t seed = 1;
  int gdb_port = 0;  // 0: no gdb
  // Where the board's parts leave files (the run's folder), and whose they are in a run of several
  // boards. Empty: nothing is left.
  std::string folder = {}, node = {};

  bool operator==(const BoardRun&) const = default;
};

// All that a board's process is told at its start.
struct BoardStart {
  BoardDescription board = {};
  BoardRun run = {};

  bool operator==(const BoardStart&) const = default;
};

}  // namespace whirl
