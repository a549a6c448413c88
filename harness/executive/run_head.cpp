// What a run's file of messages begins with.
#include "harness/executive/run.hpp"
#include "harness/lockstep/lockstep.hpp"

namespace whirl {

std::vector<results::Column> columns_of(const World& world) {
  std::vector<results::Column> columns;
  for (const Signal& signal : world.signals()) {
    columns.push_back({signal.name, si_suffix(signal.dimension), si_symbol(signal.dimension)});
  }
  return columns;
}

results::RunHead run_head(const plan::Plan& plan, const std::vector<Node>& nodes,
                          const World& world, std::uint64_t seed) {
  results::RunHead head{plan.name, seed, kLockstep_ns, columns_of(world), {}};
  for (const Node& node : nodes) {
    results::NodeHead& named = head.nodes.emplace_back();
    named.name = node.name;
    for (const BoardDevice& device : node.board.devices) {
      named.devices.push_back(device.name);
      named.buses.push_back(device_bus(device));
      if (device.type == "pulse_source") named.throttles.push_back(device.motor);
    }
    named.bauds_Hz = node.board.bauds_Hz();
    for (const BoardPin& pin : node.board.pins) named.pins.push_back(pin.name);
    named.watch = node.board.watch;
  }
  return head;
}

}  // namespace whirl
