#include "harness/cli/board_wires.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "harness/board/wire_ends.hpp"
#include "io_bridges/board_description/bus_kind.hpp"
#include "io_bridges/board_description/bus_name.hpp"

namespace whirl::cli {
namespace {

Error wrong(const plan::Plan& plan, const std::string& what, const std::string& cure) {
  return {ErrorKind::bad_input, plan.place, "wires: " + what, cure};
}

// From each follower to its leader, until there is none.
Result<Done> check_circles(const plan::Plan& plan, const std::vector<Node>& nodes) {
  std::map<std::size_t, std::size_t> leader_of;
  for (const plan::PlanBoardWire& wire : plan.board_wires) {
    if (leader_of.emplace(wire.follower, wire.leader).first->second != wire.leader) {
      return wrong(plan, nodes[wire.follower].name + " takes the place of devices of two boards",
                   "a board follows one");
    }
  }
  for (const auto& [first, leader] : leader_of) {
    std::string way = nodes[first].name;
    std::size_t at = first;
    for (std::size_t steps = 0; leader_of.count(at) != 0; ++steps) {
      at = leader_of[at];
      way = nodes[at].name + " -> " + way;
      if (at == first) {
        return wrong(plan, "boards lead each other in a circle: " + way,
                     "each would wait for the other");
      }
      if (steps > nodes.size()) break;  // a circle that this one hangs on is found from within
    }
  }
  return Done{};
}

// Both ends are of one kind.
Result<Done> check_buses(const plan::Plan& plan, const plan::PlanBoardWire& wire,
                         const BoardDevice& device, const std::string& name) {
  const BusKind kind = bus_kind(device.bus);
  if (kind == BusKind::none || (kind == BusKind::i2c && device.address < 0)) {
    return wrong(plan, name + " is no target on an I2C or SPI bus, and on no UART", "");
  }
  if (kind != bus_kind(wire.bus)) {
    return wrong(plan, name + " is on " + device.bus + ", the other end on " + wire.bus,
                 "both are I2C, both SPI, or both a UART");
  }
  return Done{};
}

// A bus of the follower carries one of the leader's.
Result<Done> check_one_to_one(const plan::Plan& plan, const std::vector<Node>& nodes) {
  std::map<std::pair<std::size_t, std::string>, std::string> masters;
  std::map<std::size_t, int> motors;
  for (const plan::PlanBoardWire& wire : plan.board_wires) {
    const BoardDevice& device = *nodes[wire.leader].board.find(wire.device);
    const std::string& follower = nodes[wire.follower].name;
    const bool one_only = bus_kind(wire.bus) != BusKind::i2c;  // device for the whole bus
    const std::string master = one_only ? wire.device : device.bus;
    const auto [place, fresh] = masters.emplace(std::pair(wire.follower, wire.bus), master);
    if (!fresh && (one_only || place->second != master)) {
      return wrong(plan, follower + "." + wire.bus + " has two masters",
                   "each bus of a board follows one");
    }
    if (device.motor == 0 || plays_parts(nodes[wire.follower].board)) continue;
    if (!motors.emplace(wire.follower, device.motor).second) {
      return wrong(plan, follower + " takes the place of two motors' devices",
                   "a board turns one motor");
    }
  }
  return Done{};
}

// A UART that a line of the plan is on has no room for another board.
Result<Done> check_lines(const plan::Plan& plan, const std::vector<Node>& nodes) {
  std::set<std::pair<std::size_t, int>> lines;
  for (const plan::PlanWire& line : plan.wires) {
    for (const auto& end : {line.a, line.b}) lines.insert({end.node, end.uart});
  }
  for (const plan::PlanBoardWire& wire : plan.board_wires) {
    if (!is_uart(wire.bus)) continue;
    const std::string& there = nodes[wire.leader].board.find(wire.device)->bus;
    for (const auto& [node, bus] : {std::pair(wire.leader, there), {wire.follower, wire.bus}}) {
      if (lines.count({node, bus_number(bus).value_or(0)}) == 0) continue;
      return wrong(plan, nodes[node].name + "." + bus + " has two wires", "");
    }
  }
  return Done{};
}

// What joins the same two boards is one wire.
struct Pair {
  std::size_t leader, follower;
  std::vector<const plan::PlanBoardWire*> wires;
};

std::vector<Pair> pairs_of(const plan::Plan& plan) {
  std::vector<Pair> pairs;
  for (const plan::PlanBoardWire& wire : plan.board_wires) {
    const auto same = std::find_if(pairs.begin(), pairs.end(), [&](const Pair& pair) {
      return pair.leader == wire.leader && pair.follower == wire.follower;
    });
    if (same != pairs.end()) {
      same->wires.push_back(&wire);
    } else {
      pairs.push_back({wire.leader, wire.follower, {&wire}});
    }
  }
  return pairs;
}

void add(const std::vector<WireEnd>& more, std::vector<WireEnd>& ends) {
  ends.insert(ends.end(), more.begin(), more.end());
}

}  // namespace

Result<Done> check_board_wires(const plan::Plan& plan, const std::vector<Node>& nodes) {
  std::set<std::pair<std::size_t, std::string>> taken;
  for (const plan::PlanBoardWire& wire : plan.board_wires) {
    const Node& leader = nodes[wire.leader];
    const std::string name = leader.name + "." + wire.device;
    const BoardDevice* device = leader.board.find(wire.device);
    if (device == nullptr) {
      return wrong(
          plan, leader.board.name + " has no device '" + wire.device + "'",
          "from = \"NODE.DEVICE\" names the device that the other board takes the place of");
    }
    if (const auto good = check_buses(plan, wire, *device, name); !good) return good.error();
    if (!taken.insert({wire.leader, wire.device}).second) {
      return wrong(plan, "two boards take the place of " + name, "");
    }
  }
  if (const auto led = check_circles(plan, nodes); !led) return led.error();
  if (const auto lines = check_lines(plan, nodes); !lines) return lines.error();
  return check_one_to_one(plan, nodes);
}

Result<std::vector<BoardWireLink>> join_boards(const plan::Plan& plan,
                                               const std::vector<Node>& nodes,
                                               std::vector<Setup>& setups) {
  std::vector<BoardWireLink> links;
  for (Pair& pair : pairs_of(plan)) {
    auto made = io::BoardWire::create(static_cast<int>(nodes.size()));
    if (!made) return made.error();
    const bool plays = plays_parts(nodes[pair.follower].board);
    std::vector<WirePlace> places;
    for (const plan::PlanBoardWire* wire : pair.wires) {
      places.push_back({wire->device, wire->bus, wire->select, wire->ready, wire->latency_ns});
      const int motor = nodes[wire->leader].board.find(wire->device)->motor;
      if (motor != 0 && !plays) setups[pair.follower].motor = motor;
      setups[pair.leader].far.push_back({pair.follower, motor, &nodes[pair.follower].board});
    }
    const WireEnds ends = wire_ends(places, made.value().fd());
    add(ends.leading, setups[pair.leader].wires);
    add(ends.following, setups[pair.follower].wires);
    links.push_back({pair.leader, pair.follower, std::move(made.value())});
  }
  return links;
}

}  // namespace whirl::cli
