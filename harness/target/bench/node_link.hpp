// The bench as a vehicle's nodes on a CAN bus of this host: sensors and ESCs that a board file hangs on it are played
// to a flight controller that is of metal, by the code that plays them on a virtual board (io_bridges/rack).
//
//   World    body_motion, esc_state and their like go to the nodes with the step; esc_setpoint comes back
//   Times    nodes live in virtual time, as far as the host's clock has come, and never beyond the step at hand: a
//            host that is late makes them late. Frames leave within 50 us of the host of when they are due
//   Frames   of ours take their time in the nodes' own bus model, then on copper: on a wire of 1 Mbit/s they are heard
//            0.13 ms later than on a virtual board. In the run's messages they have the times of the model
//   Full     at most 64 frames wait for the controller; those that find no room are dropped, counted and told
//   Safe     nothing turns here: the nodes fall silent
//   Errors   bad_input: the board has no device on that bus; host: bus-off, or the adapter is gone
#pragma once
#include <deque>

#include "harness/target/bench/can_end.hpp"
#include "harness/target/bench/link.hpp"
#include "io_bridges/rack/can_rack.hpp"

namespace whirl::bench {

struct NodeOptions {
  CanBusLink link;
  BoardDescription board;  // of it, the devices on link.bus
  rack::DeviceTypes types;
  std::uint64_t seed = 1;  // of the board: the same copies of the parts as on a virtual one
  std::string log = {};    // a file of candump's format; empty: none
};

class NodeLink final : public Link {
 public:
  NodeLink(NodeOptions options, CanMaker maker);

  std::string name() const override { return options_.link.name; }
  Result<Done> open() override;
  void keep_time(BenchTime time) override { time_ = std::move(time); }
  // Never only its own: others on other buses hear of the same world.
  bool take(const io::Reader& order, std::int64_t due_host_ns) override;
  Result<Done> serve(std::int64_t now_host_ns, Arrivals& arrivals) override;
  std::int64_t next_due_host_ns() const override;
  int file() const override { return end_.file(); }
  void make_safe() override;
  void close() override { end_.close(); }
  std::vector<std::pair<std::string, std::string>> versions() const override {
    return end_.versions();
  }
  std::vector<std::string> findings() const override;

 private:
  Result<Done> take_in();
  Result<Done> send_waiting(std::int64_t now_host_ns);
  void hand_over(Arrivals& arrivals);
  void advance(std::int64_t host_ns);

  NodeOptions options_;
  CanEnd end_;
  rack::CanRack rack_;
  BenchTime time_;
  std::deque<io::CanFrame> waiting_;  // for the controller
  std::int64_t served_host_ns_ = 0, retry_host_ns_ = 0;
  std::uint64_t dropped_ = 0;
  bool safe_ = false;
};

}  // namespace whirl::bench
