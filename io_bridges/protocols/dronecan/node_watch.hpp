// Who is on a bus, by the NodeStatus that each node sends: offline ones, restarted ones, and two of one id.
//
//   Restart    the uptime is lower than it was
//   Two of one id  the uptime has come back to a count that the first of the two would have by now, after it had
//              fallen: one node cannot restart and have been running all the time. Of two that were switched on together
//              the uptimes agree; there the transfer ids, which one node counts up, stand still or step back
//              from one status to the next within 0.7 s
#pragma once
#include <array>
#include <optional>

#include "io_bridges/protocols/can_frame.hpp"
#include "io_bridges/protocols/dronecan/node.hpp"

namespace whirl::io::dronecan {

enum class NodeEvent : std::uint8_t { appeared, restarted, two_of_one_id, back_online };

class NodeWatch {
 public:
  struct Node {
    bool seen = false;
    NodeStatus status;
    std::int64_t last_ns = 0;
    std::uint32_t restarts = 0;
    bool two_of_one_id = false;
    // When it was switched on, as the last status and the one before a fall of the uptime have it.
    std::int64_t started_ns = 0, started_before_ns = 0;
    bool fell = false;
    std::optional<std::uint8_t> transfer_id;  // of the last status, where it is known
  };

  // A frame of anybody's, before repeated transfers are dropped. What is new, if it is a NodeStatus.
  std::optional<NodeEvent> on_frame(const CanFrame& frame, std::int64_t now_ns);

  // What is new of this node, if anything.
  std::optional<NodeEvent> on_status(std::uint8_t node_id, const NodeStatus& status,
                                     std::int64_t now_ns,
                                     std::optional<std::uint8_t> transfer_id = {});
  bool online(std::uint8_t node_id, std::int64_t now_ns) const;
  const Node& node(std::uint8_t node_id) const { return nodes_[node_id & 0x7F]; }

 private:
  std::array<Node, 128> nodes_{};
};

}  // namespace whirl::io::dronecan
