// What a file of messages says of its run before the first of them: the names behind its numbers.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"

namespace whirl::results {

struct Column {             // of the world's signals
  std::string name;         // "height"
  std::string unit_suffix;  // "mps"; empty for ratios and numbers
  std::string unit;         // "m/s", for people

  bool operator==(const Column&) const = default;
};

struct NodeHead {         // a board; its number is its place in RunHead::nodes (io::Header::board)
  std::string name = {};  // empty: the only one's
  std::vector<std::string> devices = {}, pins = {}, watch = {};  // by number
  std::vector<std::string> buses = {};  // of the devices: "spi1", "i2c3"; empty: of an older run
  std::map<int, double> bauds_Hz = {};  // by UART, as the board file states them
  std::vector<int> throttles = {};      // motors whose pulses a line of the board takes

  bool operator==(const NodeHead&) const = default;
};

struct RunHead {
  std::string plan = {};
  std::uint64_t seed = 0;
  std::int64_t step_ns = 1'000'000;  // from one row of signals to the next; the first is at 0
  std::vector<Column> columns = {};
  std::vector<NodeHead> nodes = {};

  bool operator==(const RunHead&) const = default;
};

std::string head_text(const RunHead& head);
// Errors  bad_input: no head of a file that this version reads
Result<RunHead> read_head(std::string_view text);

}  // namespace whirl::results
