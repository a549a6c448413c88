// The bench as a vehicle's nodes on a CAN bus of this host (rack_link.hpp): sensors and ESCs that a board file hangs on
// it, or a pod's host.
//
//   Frames   of ours take their time in the nodes' own bus model, then on copper: on a wire of 1 Mbit/s they are heard
//            0.13 ms later than on a virtual board. In the run's messages they have the times of the model
//   Node     whom the bus has is watched for two of one id and for restarts (bus_node.hpp); where the bench file names an
//            allocator, this host is that node as well
//   Full     at most 64 frames wait for the controller; those that find no room are dropped, counted and told
//   Errors   bad_input: the board has no device on that bus; host: bus-off, or the adapter is gone
#pragma once
#include <deque>

#include "harness/target/bench/bus_node.hpp"
#include "harness/target/bench/can_end.hpp"
#include "harness/target/bench/rack_link.hpp"
#include "io_bridges/rack/can_rack.hpp"

namespace whirl::bench {

struct NodeOptions {
  CanBusLink link;
  BoardDescription board;  // of it, the devices on link.bus
  rack::DeviceTypes types;
  std::uint64_t seed = 1;  // of the board: the same copies of the parts as on a virtual one
  std::string log = {};    // a file of candump's format; empty: none
  std::optional<PodPlaces> pod = {};  // they are a pod's host
};

class NodeLink final : public RackLink {
 public:
  NodeLink(NodeOptions options, CanMaker maker);

  std::string name() const override { return options_.link.name; }
  Result<Done> open() override;
  std::int64_t next_due_host_ns() const override;
  int file() const override { return end_.file(); }
  void make_safe() override;
  void close() override { end_.close(); }
  std::vector<std::pair<std::string, std::string>> versions() const override {
    return end_.versions();
  }
  std::vector<std::string> findings() const override;

 private:
  Result<Done> take_in(std::int64_t now_host_ns) override;
  Result<Done> send_waiting(std::int64_t now_host_ns) override;

  NodeOptions options_;
  CanEnd end_;
  void add_waiting(const io::CanFrame& frame);

  rack::CanRack rack_;
  BusNode node_;
  std::deque<io::CanFrame> waiting_;  // for the controller
  std::int64_t retry_host_ns_ = 0;
  std::uint64_t dropped_ = 0;
  bool safe_ = false;
};

}  // namespace whirl::bench
