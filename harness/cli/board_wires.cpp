#include "harness/cli/board_wires.hpp"

#include <map>
#include <set>

namespace whirl::cli {
namespace {

Error wrong(const plan::Plan& plan, const std::string& what, const std::string& cure) {
  return {ErrorKind::bad_input, plan.place, "wires: " + what, cure};
}

// From each follower to its leader, until there is none.
Result<Done> check_circles(const plan::Plan& plan, const std::vector<Node>& nodes) {
  std::map<std::size_t, std::size_t> leader_of;
  for (const plan::PlanBoardWire& wire : plan.board_wires) {
    if (!leader_of.emplace(wire.follower, wire.leader).second) {
      return wrong(plan, nodes[wire.follower].name + " takes the place of two devices",
                   "a board follows one master");
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
    if (!device->bus.starts_with("i2c") || device->address < 0) {
      return wrong(plan, name + " is no target on an I2C bus", "");
    }
    if (!taken.insert({wire.leader, wire.device}).second) {
      return wrong(plan, "two boards take the place of " + name, "");
    }
  }
  return check_circles(plan, nodes);
}

Result<std::vector<BoardWireLink>> join_boards(const plan::Plan& plan,
                                               const std::vector<Node>& nodes,
                                               std::vector<Setup>& setups) {
  std::vector<BoardWireLink> links;
  for (const plan::PlanBoardWire& wire : plan.board_wires) {
    auto made = io::BoardWire::create(static_cast<int>(nodes.size()));
    if (!made) return made.error();
    const int fd = made.value().fd();
    setups[wire.leader].wires.push_back({.device = wire.device, .fd = fd});
    setups[wire.follower].wires.push_back({.bus = wire.bus, .fd = fd});
    const BoardDescription& led = nodes[wire.leader].board;
    const int motor = led.find(wire.device)->motor;
    setups[wire.follower].motor = motor;
    setups[wire.leader].far.push_back({wire.follower, motor, &nodes[wire.follower].board});
    links.push_back({wire.leader, wire.follower, std::move(made.value())});
  }
  return links;
}

}  // namespace whirl::cli
