#include "harness/cli/board_wires.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "harness/board/wire_ends.hpp"
#include "io_bridges/board_description/analog_device.hpp"
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

// A board joins its CAN to another one's also where it takes no device's place.
bool joins_bus(const std::vector<Node>& nodes, const plan::PlanBoardWire& wire) {
  return nodes[wire.leader].board.find(wire.device) == nullptr &&
         bus_kind(wire.device) == BusKind::can && bus_number(wire.device);
}

// Of the leader.
std::string bus_there(const std::vector<Node>& nodes, const plan::PlanBoardWire& wire) {
  const BoardDevice* device = nodes[wire.leader].board.find(wire.device);
  return device == nullptr ? wire.device : device->bus;
}

int motor_of(const std::vector<Node>& nodes, const plan::PlanBoardWire& wire) {
  const BoardDevice* device = nodes[wire.leader].board.find(wire.device);
  return device == nullptr ? 0 : device->motor;
}

// Both ends are of one kind.
Result<Done> check_buses(const plan::Plan& plan, const std::vector<Node>& nodes,
                         const plan::PlanBoardWire& wire, const std::string& name) {
  const std::string bus = bus_there(nodes, wire);
  const BoardDevice* device = nodes[wire.leader].board.find(wire.device);
  const BusKind kind = device != nullptr && puts_a_level(*device) ? BusKind::dac : bus_kind(bus);
  if (kind == BusKind::none ||
      (kind == BusKind::i2c && (device == nullptr || device->address < 0))) {
    return wrong(
        plan, name + " is no target on an I2C, SPI or CAN bus, and on no UART or analog pin", "");
  }
  if (kind != bus_kind(wire.bus)) {
    return wrong(plan, name + " is on " + bus + ", the other end on " + wire.bus,
                 "both are I2C, both SPI, both CAN, both a UART, or an analog pin and a DAC");
  }
  return Done{};
}

// Boards wait for each other by another rule on CAN than on the wires of a master: so two that share a CAN share nothing
// else. And a bus has one arbiter, to which all are joined.
Result<Done> check_can(const plan::Plan& plan, const std::vector<Node>& nodes) {
  for (const plan::PlanBoardWire& wire : plan.board_wires) {
    if (bus_kind(wire.bus) != BusKind::can) continue;
    const std::string& leader = nodes[wire.leader].name;
    const std::string bus = bus_there(nodes, wire);
    for (const plan::PlanBoardWire& other : plan.board_wires) {
      const bool same = other.leader == wire.leader && other.follower == wire.follower;
      if (&other != &wire && same) {
        return wrong(plan,
                     leader + " and " + nodes[wire.follower].name + " share a CAN bus and more",
                     "two boards that a CAN bus joins have no other wire");
      }
      if (other.follower == wire.leader && other.bus == bus) {
        return wrong(plan,
                     leader + "." + bus + " is part of " + nodes[other.leader].name + "'s bus",
                     "join " + nodes[wire.follower].name + " to that one: it arbitrates");
      }
    }
  }
  return Done{};
}

// A bus of the follower carries one of the leader's.
Result<Done> check_one_to_one(const plan::Plan& plan, const std::vector<Node>& nodes) {
  std::map<std::pair<std::size_t, std::string>, std::string> masters;
  std::map<std::size_t, int> motors;
  for (const plan::PlanBoardWire& wire : plan.board_wires) {
    const std::string& follower = nodes[wire.follower].name;
    const bool one_only = bus_kind(wire.bus) != BusKind::i2c;  // device for the whole bus
    const std::string master = one_only ? wire.device : bus_there(nodes, wire);
    const auto [place, fresh] = masters.emplace(std::pair(wire.follower, wire.bus), master);
    if (!fresh && (one_only || place->second != master)) {
      return wrong(plan, follower + "." + wire.bus + " has two masters",
                   "each bus of a board follows one");
    }
    const int motor = motor_of(nodes, wire);
    if (motor == 0 || plays_parts(nodes[wire.follower].board)) continue;
    if (!motors.emplace(wire.follower, motor).second) {
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
    const std::string there = bus_there(nodes, wire);
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
    const bool joins = joins_bus(nodes, wire);
    if (leader.board.find(wire.device) == nullptr && !joins) {
      return wrong(
          plan, leader.board.name + " has no device '" + wire.device + "'",
          "from = \"NODE.DEVICE\" names the device that the other board takes the place of");
    }
    if (const auto good = check_buses(plan, nodes, wire, name); !good) return good.error();
    if (!joins && !taken.insert({wire.leader, wire.device}).second) {
      return wrong(plan, "two boards take the place of " + name, "");
    }
  }
  if (const auto led = check_circles(plan, nodes); !led) return led.error();
  if (const auto lines = check_lines(plan, nodes); !lines) return lines.error();
  if (const auto shared = check_can(plan, nodes); !shared) return shared.error();
  return check_one_to_one(plan, nodes);
}

void note_joined(const plan::Plan& plan, std::vector<Node>& nodes) {
  for (const plan::PlanBoardWire& wire : plan.board_wires) {
    if (bus_kind(wire.bus) != BusKind::can) continue;
    nodes[wire.follower].joined[wire.bus] = nodes[wire.leader].qualified(bus_there(nodes, wire));
  }
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
      const int motor = motor_of(nodes, *wire);
      if (motor != 0 && !plays) setups[pair.follower].motor = motor;
      setups[pair.leader].far.push_back({pair.follower, motor, &nodes[pair.follower].board});
    }
    WireEnds ends = wire_ends(places, made.value().fd());
    if (joins_bus(nodes, *pair.wires.front())) {
      WireEnd& end = ends.leading.front();
      end.bus = std::exchange(end.device, "");
      end.arbitrates = true;
      end.far = nodes[pair.follower].name;
    }
    add(ends.leading, setups[pair.leader].wires);
    add(ends.following, setups[pair.follower].wires);
    links.push_back({pair.leader, pair.follower, std::move(made.value())});
  }
  return links;
}

}  // namespace whirl::cli
