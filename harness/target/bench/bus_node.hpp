// This host as a node of a bench's CAN bus, beside set-points or played parts: who is there, and what a flight
// controller's node does for an ESC that is not ours.
//
//   Node     NodeStatus each second, GetNodeInfo answered; it asks each node that appears or restarts who it is
//   Ids      given to nodes that have none (allocation.hpp), once the statuses of a second have told which are in use
//   Arming   ArmingStatus 255 twice a second, where it arms: AM32 and AP_Periph turn no motor without it
//   Watch    two nodes of one id, ours included, and nodes that restart: findings of the run
//   Times    virtual; one that goes back counts as no time passed
//   Left out a table of given ids that outlives the run: `ids` of the bench file is one
#pragma once
#include <array>
#include <bitset>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/target/bench/bench_description.hpp"
#include "io_bridges/protocols/dronecan/allocation.hpp"
#include "io_bridges/protocols/dronecan/local_node.hpp"

namespace whirl::bench {

struct BusNodeOptions {
  std::optional<std::uint8_t> node = {};  // its id; none: it only listens
  bool arms = false;                      // pre: it has an id
  NodeIds ids = {};
};

class BusNode {
 public:
  BusNode(const BusNodeOptions& options, io::dronecan::LocalNode::FrameSink send);

  void poll(std::int64_t now_ns);
  // Of another node of the bus.
  void on_frame(const io::CanFrame& frame, std::int64_t now_ns);
  // Of this host, by whomever: its source is one of ours.
  void on_own(const io::CanFrame& frame);

  std::vector<std::string> findings() const;
  // {"node 20", "org.example.esc, version 1.2, unique id 0011.."}, {"node id 125 given to", "0011.."}
  std::vector<std::pair<std::string, std::string>> figures() const;

 private:
  struct Known {
    std::string name;
    int major = 0, minor = 0;
    std::optional<io::dronecan::UniqueId> unique_id, other_unique_id;
    std::optional<std::int64_t> restarted_ns;  // the first time
  };
  void on_event(io::dronecan::NodeEvent event, std::uint8_t node, std::int64_t now_ns);
  void on_transfer(const io::dronecan::Transfer& transfer, std::int64_t now_ns);
  void on_info(std::uint8_t node, const io::dronecan::GetNodeInfoResponse& info);
  std::string trouble_of(std::uint8_t node) const;  // empty: none

  bool arms_;
  std::optional<io::dronecan::LocalNode> node_;
  io::dronecan::NodeWatch watch_;
  io::dronecan::Allocator allocator_;
  std::optional<std::int64_t> begun_ns_;
  std::int64_t next_arming_ns_ = 0;
  std::bitset<128> ours_, ours_twice_;
  std::array<Known, 128> known_;
  std::vector<std::pair<std::uint8_t, io::dronecan::UniqueId>> granted_;
};

}  // namespace whirl::bench
