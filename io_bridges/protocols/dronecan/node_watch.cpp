#include "io_bridges/protocols/dronecan/node_watch.hpp"

#include <algorithm>
#include <cstdlib>

#include "io_bridges/protocols/dronecan/transfer.hpp"

namespace whirl::io::dronecan {
namespace {

// Uptimes are whole seconds, and a status may be late by a second.
constexpr std::int64_t kSame_start_ns = 2'000'000'000;
// CAN delivers a frame twice where the last bit of its end is spoilt: the second follows at once.
constexpr std::int64_t kDelivered_twice_ns = 10'000'000;
// A node that has just started may have started twice, with transfer id 0 each time. Beyond that one cannot be younger
// than it was within kTwo_within_ns.
constexpr std::uint32_t kSettled_s = 2;
// Of two nodes' statuses, one a second each, one follows another within half a second. A node whose transfer ids jump,
// for all its types share one count, sends one a second.
constexpr std::int64_t kTwo_within_ns = 700'000'000;
constexpr int kMost_ahead = 24;  // of 32: what is more is a step back

// Two nodes count their transfers each by itself; `before`, and `now` behind it.
bool counts_of_two(std::uint8_t before, std::uint8_t now) {
  const int ahead = (now - before) & tail::kTransfer_id;
  return ahead == 0 || ahead > kMost_ahead;
}

}  // namespace

std::optional<NodeEvent> NodeWatch::on_frame(const CanFrame& frame, std::int64_t now_ns) {
  const auto header = frame.extended && !frame.remote ? parse_can_id(frame.id) : std::nullopt;
  if (!header || header->kind != Kind::message || header->type_id != NodeStatus::kType.id ||
      header->source == 0 || frame.length != NodeStatus::kType.most_bytes + 1) {
    return std::nullopt;
  }
  const std::uint8_t tail_byte = frame.data[NodeStatus::kType.most_bytes];
  if ((tail_byte & ~tail::kTransfer_id) != (tail::kStart | tail::kEnd)) return std::nullopt;
  const auto status = decode<NodeStatus>(frame.bytes().first(NodeStatus::kType.most_bytes));
  if (!status) return std::nullopt;
  const std::uint8_t transfer_id = tail_byte & tail::kTransfer_id;
  const Node& before = node(header->source);
  if (before.seen && before.transfer_id == transfer_id &&
      now_ns - before.last_ns < kDelivered_twice_ns) {
    return std::nullopt;
  }
  return on_status(header->source, *status, now_ns, transfer_id);
}

std::optional<NodeEvent> NodeWatch::on_status(std::uint8_t node_id, const NodeStatus& status,
                                              std::int64_t now_ns,
                                              std::optional<std::uint8_t> transfer_id) {
  Node& node = nodes_[node_id & 0x7F];
  const bool first = !node.seen, was_online = online(node_id, now_ns);
  const bool fell = !first && status.uptime_s < node.status.uptime_s;
  const std::int64_t started_ns = now_ns - std::int64_t{status.uptime_s} * 1'000'000'000;
  const bool as_before = node.fell &&
                         std::abs(started_ns - node.started_before_ns) <= kSame_start_ns &&
                         std::abs(started_ns - node.started_ns) > kSame_start_ns;
  const bool counts_twice = !first && node.transfer_id && transfer_id &&
                            std::min(status.uptime_s, node.status.uptime_s) >= kSettled_s &&
                            now_ns - node.last_ns < kTwo_within_ns &&
                            counts_of_two(*node.transfer_id, *transfer_id);
  if (fell) {
    node.started_before_ns = node.started_ns;
    node.fell = true;
  }
  node.seen = true;
  node.status = status;
  node.last_ns = now_ns;
  node.started_ns = started_ns;
  node.transfer_id = transfer_id;
  if (first) return NodeEvent::appeared;
  if ((as_before && !fell) || counts_twice) {
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
