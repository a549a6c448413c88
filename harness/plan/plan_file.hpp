// A plan file: Lua that declares one or more plans, each with what it needs and a function to run.
//
//   plan "hover" { image = "flight", board = "px4fmu_v1", vehicle = "hp_quad", tags = { "quick" },
//                  seed = 1, timeout = "60 s", watch = { "fw::imu_task" },
//                  may_reset = false, late = "200 us", late_share = "1 %",
//                  run = function(t) ... end }
//   Nodes    instead of image, board, watch and may_reset: nodes = { { name = "esc", image = "esc", board = "esc32v2",
//            watch = { ... } }, ... }; the vehicle or stand surrounds the first. wires = { { from = "esc.usart1",
//            to = "fc.usart2" }, ... } join their UARTs at the grain of the exchange; { from = "fc.esc1", to = "esc.i2c2" }:
//            that board takes the place of the device esc1 on fc's bus; { from = "fc.imu", to = "pod.spi1", select = "PA15",
//            ready = "PC4", latency = "100 us" } on SPI; { from = "fc.gps", to = "pod.usart6", fastest = "57600 baud" } on a UART;
//            { from = "fc.battery", to = "pod.dac1", latency = "100 us" } at an analog pin;
//            { from = "flight.esc1", to = "esc.can1" } on CAN, and { from = "a.can1", to = "b.can1" } joins two CANs
//            A node's flash = { "esc_motor_1" } names ELF files that are flashed beside its image
//   Late     on a bench, of the host: a step later than `late` counts, and more than `late_share` of them make the run
//            inconclusive. What is not said is the bench's own; a virtual board is never late
//   Stand    instead of vehicle: stand = { prop = "hk_10x4.5", battery = "4s_2200" }
//   Around   of a vehicle: start, room, outdoors, fence, obstacles, field, air, load, read by who makes the world
//   Limits   tags and names are checked; a plan without run, image or name is refused with its line
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "base/setting.hpp"
#include "harness/lua/sandbox.hpp"
#include "harness/lua/table.hpp"
#include "harness/plan/source_calls.hpp"

namespace whirl::plan {

struct PlanNode {
  std::string name;          // empty: the plan has one image and one board
  std::string image, board;  // as written: names or paths
  std::vector<std::string> watch;
  bool may_reset = false;               // by a watchdog, without failing the plan
  std::vector<std::string> flash = {};  // beside the image; names or paths
};

struct PlanWire {  // from UART to UART, both ways
  struct End {
    std::size_t node = 0;
    std::uint16_t uart = 1;
  };
  End a, b;
};

struct PlanBoardWire {  // a board in the place of another one's device
  std::size_t leader = 0;
  std::string device;  // of the leader's board; or its bus, "can1", where none has its place taken
  std::size_t follower = 0;
  std::string bus;  // of the follower: "i2c2", "spi1", "can1", "usart6", "dac1"
  // Of SPI: the follower's pins, `ready` may be empty, and its line's latency. Of a UART: its shortest character.
  std::string select = {}, ready = {};
  std::int64_t latency_ns = 0;
};

struct Plan {
  std::string name, file, place;
  std::string vehicle;          // as written: a name or a path
  Settings vehicle_settings;    // what the plan has other than the vehicle's file
  std::vector<PlanNode> nodes;  // one at least
  std::vector<PlanWire> wires;
  std::vector<PlanBoardWire> board_wires;
  std::vector<std::string> tags;
  std::vector<SourceCall> calls;  // of t's, in the text of its function
  std::vector<SourceCall> words;  // all names and texts in it
  std::uint64_t seed = 1;
  std::int64_t timeout_ns = 0;
  std::optional<std::int64_t> late_ns = {};
  std::optional<double> late_share = {};
  std::optional<lua::Table> stand;
  std::optional<lua::Table> surroundings;  // of a vehicle: the plan's whole table
  int run_ref = 0;                         // in the file's Lua registry

  bool has_tag(const std::string& tag) const;
};

// For a command that runs one board without a plan of the user's; `place` is what its messages name.
Plan plan_of_one_board(const std::string& name, const std::string& place);

class PlanFile {
 public:
  struct Instead {
    std::string file_name, path;  // empty: nothing is replaced
  };
  // settings: those of "plan." and "stand." take the place of what each plan of the file says.
  // instead: an included file of that name is read from there.
  static Result<std::unique_ptr<PlanFile>> load(const std::string& path, lua::Limits limits = {},
                                                const Settings& settings = {},
                                                const Instead& instead = {});

  const std::vector<Plan>& plans() const { return plans_; }
  lua::Sandbox& sandbox() { return sandbox_; }

 private:
  PlanFile(std::string path, lua::Limits limits, Settings settings)
      : path_(std::move(path)), settings_(std::move(settings)), sandbox_(limits) {}
  static int declare(lua_State* L);
  static int add_plan(lua_State* L);

  std::string path_;
  Settings settings_;
  lua::Sandbox sandbox_;
  std::vector<Plan> plans_;
};

}  // namespace whirl::plan
