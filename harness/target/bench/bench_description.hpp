// A bench: a physical board, what of this host its buses hang on, and when all of it is made safe.
//
//   Links        each stands for a part of the board file that is the world's end of a bus: an i2c_master by a USB
//                bridge, a `serial` by a serial line; a CAN bus by a network interface
//   Instruments  lines of text with numbers, each a signal: load cell, tachometer, meters
//   Safety       limits on signals, a limit on time, the phrase that who runs it has to say
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/units.hpp"
#include "io_bridges/board_description/board_description.hpp"

namespace whirl::bench {

struct SerialLink {
  std::string name, path;
  std::uint16_t uart = 1;
  int baud = 115200;
  bool mavlink = false;  // said to be a telemetry radio's, or a cable's in its place
};

struct BridgeLink {  // USB to I2C
  std::string name;
  std::string kind;    // "mcp2221a", "cp2112"
  std::string serial;  // number of the bridge; empty: the only one
  std::uint16_t bus = 2;
  double rate_Hz = 100e3;
  std::int64_t timeout_ns =
      20'000'000;  // of the host; the ESC's longest answer takes one millisecond
  std::int64_t urgent_timeout_ns = 8'000'000;  // of the stop's zero
};

struct NodeIds {  // that this host gives to nodes which have none
  std::uint8_t lowest = 1, highest = 125;
  std::vector<std::pair<std::array<std::uint8_t, 16>, std::uint8_t>> kept = {};  // by unique id
};

struct CanBusLink {             // a network interface of SocketCAN
  std::string name, interface;  // "bus", "can0"
  std::uint16_t bus = 1;
  std::uint32_t bit_rate_bps = 1'000'000;  // that it must have; a virtual one has none
  NodeIds ids = {};
  std::optional<std::uint8_t> allocator =
      {};  // of a vehicle's bus: this host's node that gives them
};

struct PodLink {  // a pod's host, on a serial line or on CAN
  std::string name, board;
  std::string path;             // empty: on CAN
  CanBusLink can;               // of these the bus is the pod's own
  BoardDescription parts = {};  // of the board: read where the bench is chosen
};

struct Reading {  // the n-th number of a line, (number - zero) * scale
  std::string signal;
  Dimension dimension = Dimension::none;
  int column = 1;
  double scale_SI = 1.0, zero = 0.0;
};

struct Instrument {
  std::string name, path;
  int baud = 115200;
  std::int64_t delay_ns = 0;  // from what is measured to the end of its line
  std::vector<Reading> readings;
};

struct Limit {
  std::string signal;
  Dimension dimension = Dimension::none;
  double low = 0.0, high = 0.0;  // SI
};

struct Safety {
  std::string phrase;
  std::vector<Limit> limits;
  std::int64_t longest_ns = 0;  // of a run
  std::int64_t heartbeat_ns =
      0;  // of the host: silence of our own loop after which the links make safe
};

struct AnalyserClips {     // of a logic analyser
  std::string driver;      // of libsigrok: "fx2lafw"
  std::string connection;  // "1.4", empty: the first that is found
  std::string model;       // that it must be; empty: any
  double rate_Hz = 24e6;
  std::map<std::string, std::string>
      channels;        // {"D0", "i2c2_scl"}: names as in io_bridges/copper/channel_name.hpp
  std::string marker;  // the serial line whose RTS pulses mark the time

  bool sees(const std::string& wires) const {  // "i2c2": has a channel of it; "pin_x": that one
    for (const auto& [clip, wire] : channels) {
      if (wire == wires || wire.starts_with(wires + "_")) return true;
    }
    return false;
  }
};

struct DebugProbe {               // by openocd
  std::string interface, target;  // its configuration files
  std::string serial;             // of the probe; empty: the only one
  double speed_Hz = 4e6;
  std::string idle;  // function in which the image idles; empty: wherever it waits for an interrupt
};

struct BenchDescription {
  std::string file, name, board;  // the board's name, as plans write it
  double pace = 1.0;
  std::int64_t late_ns = 0;  // of the host: what counts as late
  double late_share = 0.0;   // of the steps: more makes a run inconclusive
  std::vector<SerialLink> serials;
  std::vector<BridgeLink> bridges;
  std::vector<CanBusLink> cans;
  std::vector<PodLink> pods;
  std::vector<Instrument> instruments;
  std::optional<AnalyserClips> analyser;
  std::optional<DebugProbe> probe;
  std::map<std::string, std::string> signals;  // other names: {"speed", "told_speed"}
  Safety safety;

  // In the order of the ports of instrument_reading.
  std::vector<Reading> readings() const {
    std::vector<Reading> all;
    for (const Instrument& i : instruments) {
      all.insert(all.end(), i.readings.begin(), i.readings.end());
    }
    return all;
  }
};

}  // namespace whirl::bench
