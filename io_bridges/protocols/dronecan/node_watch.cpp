#include "io_bridges/protocols/dronecan/node_watch.hpp"

#include <cstdlib>

namespace whirl::io::dronecan {
namespace {

// Uptimes are whole seconds, and a status may be late by a second.
constexpr std::int64_t kSame_start_ns = 2'000'000'000;

}  // namespace

std::optional<NodeEvent> NodeWatch::on_status(std::uint8_t node_id, const NodeStatus& status,
                                              std::int64_t now_ns) {
  Node& node = nodes_[node_id & 0x7F];
  const bool first = !node.seen, was_online = online(node_id, now_ns);
  const bool fell = !first && status.uptime_s < node.status.uptime_s;
  const std::int64_t started_ns = now_ns - std::int64_t{status.uptime_s} * 1'000'000'000;
  const bool as_before = node.fell &&
                         std::abs(started_ns - node.started_before_ns) <= kSame_start_ns &&
                         std::abs(started_ns - node.started_ns) > kSame_start_ns;
  if (fell) {
    node.started_before_ns = node.started_ns;
    node.fell = true;
  }
  node.seen = true;
  node.status = status;
  node.last_ns = now_ns;
  node.started_ns = started_ns;
  if (first) return NodeEvent::appeared;
  if (as_before && !fell) {
    if (node.two_of_one_id) return std::nullopt;
    node.two_of_one_id = true;
    return NodeEvent::two_of_one_id;
  }
  if (fell && !node.two_of_one_id) return ++node.restarts, NodeEvent::restarted;
  if (!was_online) return NodeEvent::back_online;
  return std::nullopt;
}

bool NodeWatch::online(std::uint8_t node_id, std::int64_t now_ns) const {
  const Node& one = node(node_id);
  return one.seen && now_ns - one.last_ns <= NodeStatus::kOffline_ns &&
         one.status.mode != NodeStatus::offline;
}

}  // namespace whirl::io::dronecan
