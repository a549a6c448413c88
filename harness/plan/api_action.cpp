// t:command, t:gust, t:fault: what a plan does to the world and to the board.
#include <algorithm>
#include <cmath>
#include <string_view>

#include "harness/plan/needs.hpp"
#include "harness/plan/raise.hpp"
#include "harness/plan/requests.hpp"
#include "harness/plan/values.hpp"
#include "io_bridges/board_description/bus_name.hpp"

namespace whirl::plan {
namespace {

constexpr int kMost_motors =
    12;  // of a vehicle (plant/base/motor_count.hpp); it refuses what it lacks

int command(lua_State* L) {
  Script& script = Script::of(L);
  script.act();
  const lua::Table table = check_table(L, 2);
  if (auto done = script.give_command(table); !done) raise(L, done.error());
  return 0;
}

// t:at("12.345 s", { radio = "fd09..." }): t:command, when the run's time has come; the plan does not wait.
int at(lua_State* L) {
  Script& script = Script::of(L);
  const auto when = parse_quantity_as(check_text(L, 2, "a time"), Dimension::time, "");
  if (!when) raise(L, when.error());
  const std::int64_t t_ns = std::llround(when.value() * 1e9);
  if (t_ns < script.stage().now_ns) raise(L, "t:at: that time has passed");
  const lua::Table table = check_table(L, 3);
  if (auto good = script.add_timed_command(t_ns, table); !good) raise(L, good.error());
  return 0;
}

int gust(lua_State* L) {
  Script::of(L).act();
  const Stage& stage = Script::of(L).stage();
  const lua::Table table = check_table(L, 2);
  if (auto done = disturb(stage.world, table, stage.now_ns); !done) raise(L, done.error());
  return 0;
}

// t:hold { roll = "90 deg", over = "2 s" }: a hand takes the vehicle and turns it there.
int hold_by_hand(lua_State* L) {
  Script::of(L).act();
  const Stage& stage = Script::of(L).stage();
  const lua::Table table = check_table(L, 2);
  if (auto done = hold(stage.world, table, stage.now_ns); !done) raise(L, done.error());
  return 0;
}

// t:release(), t:release { over = "2 s" }
int release_from_hand(lua_State* L) {
  Script::of(L).act();
  const Stage& stage = Script::of(L).stage();
  if (lua_isnoneornil(L, 2)) {
    lua_settop(L, 1);
    lua_newtable(L);
  }
  const lua::Table table = check_table(L, 2);
  if (auto done = release(stage.world, table, stage.now_ns); !done) raise(L, done.error());
  return 0;
}

int named_bus(lua_State* L, const std::string& bus) {
  const auto number = bus_number(bus);
  if (!number) raise(L, "'" + bus + "' is no bus", "write it as \"i2c3\", \"spi1\" or \"usart2\"");
  return *number;
}

fault_at::Device device_at(lua_State* L, const std::string& name, const BoardDescription& board) {
  const BoardDevice* device = board.find(name);
  if (device == nullptr) raise(L, "unknown device '" + name + "' on " + board.name);
  // One on a pin ("PA10") has its number on the board alone.
  const bool on_pin = device->bus.starts_with('P');
  const int bus = on_pin ? -1 : named_bus(L, device_bus(*device));
  return {name, bus, device->address != -1 ? device->address : board.number(name), device->motor};
}

fault_at::Wire wire_at(lua_State* L, const lua::Table& asked, const std::string& bus) {
  fault_at::Wire wire;
  wire.name = bus;
  if (asked.has("bus")) wire.bus = named_bus(L, wire.name);
  wire.address = static_cast<int>(asked.integer_or("address", -1, 0, 0x7F));
  return wire;
}

fault_at::Function function_at(lua_State* L, const std::string& name,
                               const BoardDescription& board) {
  const int number = board.watch_number(name);
  if (number < 0) raise(L, "'" + name + "' is not watched", "add it to the watch list");
  return {name, number};
}

// The board that a fault's place is on, and the place without its node's name. What is of the whole board has
// its node alone: t:fault { kind = "reset_pin", node = "esc2" }
NodePlace node_of_fault(lua_State* L, const lua::Table& asked, const std::vector<Node>& nodes) {
  for (const char* key : {"device", "bus", "function", "node"}) {
    if (!asked.has(key)) continue;
    const bool whole = std::string_view(key) == "node";
    const auto place = node_place(nodes, asked.text(key) + (whole ? "/." : ""));
    if (!place) raise(L, place.error().what, place.error().cure);
    return place.value();
  }
  return {};
}

// device, bus and address, motor or function; without any it is everywhere. `at` is where.
FaultPlace place_of_fault(lua_State* L, const lua::Table& asked, const std::string& at,
                          const BoardDescription& board) {
  const bool on_wire = asked.has("bus") || asked.has("address");
  const int places = static_cast<int>(asked.has("device")) + static_cast<int>(on_wire) +
                     static_cast<int>(asked.has("motor")) + static_cast<int>(asked.has("function"));
  if (places > 1) {
    raise(L, "a fault has one place", "device, bus (and address), motor or function");
  }
  if (asked.has("device")) return device_at(L, at, board);
  if (asked.has("function")) return function_at(L, at, board);
  if (asked.has("motor")) {
    return fault_at::Motor{static_cast<int>(asked.integer("motor", 1, kMost_motors))};
  }
  if (on_wire) return wire_at(L, asked, at);
  return fault_at::Anywhere{};
}

// Faults of a CAN bus act where it is arbitrated.
void refuse_on_joined(lua_State* L, const FaultSpec& fault, const Node& node) {
  if (!fault.kind.starts_with("can_")) return;
  std::string bus = target_of(fault);
  if (std::holds_alternative<fault_at::Device>(fault.place))
    bus = device_bus(*node.board.find(bus));
  const auto joined = node.joined.find(bus);
  if (joined == node.joined.end()) return;
  raise(L, node.name + "/" + bus + " is part of " + joined->second,
        "name that one, or the device of its board that " + node.name + " takes the place of");
}

// Which of the things that the device senses: its number there.
int axis_number(const lua::Table& asked, const FaultPlace& place, const BoardDescription& board) {
  const auto* at = std::get_if<fault_at::Device>(&place);
  const BoardDevice* device = at == nullptr ? nullptr : board.find(at->name);
  if (device == nullptr || device->senses.empty()) {
    asked.refuse("axis", "is of a device that senses something");
    return 0;
  }
  const std::string word = asked.choice("axis", device->senses);
  const auto found = std::find(device->senses.begin(), device->senses.end(), word);
  return static_cast<int>(found - device->senses.begin());
}

bool can_spoil(const Stage& stage, const FaultSpec& fault) {
  return stage.spoils ? stage.spoils(target_of(fault), fault.kind)
                      : stage.offers.has(Offer::wire_faults);
}

// t:fault { kind = "i2c_nack", device = "esc2", start = "0 s", duration = "100 ms", value = 1 }
// Without a duration it stays for ever. start counts from now.
int fault(lua_State* L) {
  Script& self = Script::of(L);
  self.act();
  const lua::Table asked = check_table(L, 2);
  FaultSpec fault;
  fault.kind = asked.text("kind");
  const std::vector<Node>& nodes = self.stage().nodes;
  const NodePlace at = node_of_fault(L, asked, nodes);
  fault.board = static_cast<std::uint8_t>(at.node);
  fault.place = place_of_fault(L, asked, at.rest, nodes[at.node].board);
  refuse_on_joined(L, fault, nodes[at.node]);
  if (asked.has("axis")) {
    fault.axis = axis_number(asked, fault.place, nodes[at.node].board);
  }
  fault.start_ns = self.stage().now_ns + asked.duration_ns_or("start", 0);
  if (asked.has("duration")) fault.end_ns = fault.start_ns + asked.duration_ns("duration");
  if (asked.has("value")) fault.value = asked.any_quantity("value").value_SI;
  check_finish(L, asked);
  fault.number = static_cast<std::uint32_t>(self.faults.size() + 1);
  self.faults.push_back(fault);
  // The world surrounds the first board.
  const Result<bool> taken = at.node == 0 ? self.stage().world.take_fault(fault) : false;
  if (!taken) raise(L, taken.error());
  if (!taken.value()) {
    const bool named =
        asked.has("device") || asked.has("bus") || asked.has("function") || asked.has("node");
    if (nodes.size() > 1 && !named) {
      raise(L, "a fault of kind " + fault.kind + " is on one board of several",
            "name it by its device, bus, function or node: bus = \"" + nodes[0].name + "/i2c1\"");
    }
    if (!can_spoil(self.stage(), fault)) {
      raise(L, not_offered("a fault of kind " + fault.kind, Offer::wire_faults));
    }
    if (auto sent = self.stage().inject(fault); !sent) raise(L, sent.error());
  }
  return 0;
}

}  // namespace

void add_action_calls(lua_State* L) {
  const luaL_Reg calls[] = {{"command", command},   {"at", at},
                            {"gust", gust},         {"fault", fault},
                            {"hold", hold_by_hand}, {"release", release_from_hand},
                            {nullptr, nullptr}};
  luaL_setfuncs(L, calls, 0);
}

}  // namespace whirl::plan
