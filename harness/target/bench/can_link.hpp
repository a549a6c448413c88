// A CAN bus of this host as one of the bench's links: can_order messages out, can_transfer back.
//
//   Orders     in order, each not before its time. One that the controller has no room for waits, and those behind it
//   Passed     every frame of the others (sender -1), and ours once the controller says that they have passed (sender 0).
//              How long each took, and what failed, a controller does not tell frame by frame
//   Node       from keep_time() on this host is a node of the bus beside its set-points, and arms (bus_node.hpp): behind the
//              orders that are due, and nothing of it once it is safe
//   Safe       the zero set-point as RawCommand and RPMCommand, and ArmingStatus 0: at once, ahead of what waits here,
//              then every 10 ms; and when the link is closed. Their transfer ids follow those that went out before
//   Heartbeat  without a turn of the bench's loop for so long a thread of its own makes safe
//   Bus-off    an error of the host, as is a lost adapter: nothing reaches the ESC, whose own watchdog stops it
#pragma once
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <thread>

#include "harness/target/bench/bus_node.hpp"
#include "harness/target/bench/can_end.hpp"
#include "harness/target/bench/link.hpp"

namespace whirl::bench {

struct CanOptions {
  CanBusLink link;
  std::uint8_t node = 10;         // this host's: of the stand's throttle, and of the zeros
  std::size_t escs = 4;           // to so many of them
  std::int64_t heartbeat_ns = 0;  // of the host; 0: none
  std::string log = {};           // a file of candump's format; empty: none
};

class CanLink final : public Link {
 public:
  CanLink(CanOptions options, CanMaker maker);
  ~CanLink() override;

  std::string name() const override { return options_.link.name; }
  Result<Done> open() override;
  void keep_time(BenchTime time) override;
  bool take(const io::Reader& order, std::int64_t due_host_ns) override;
  Result<Done> serve(std::int64_t now_host_ns, Arrivals& arrivals) override;
  std::int64_t next_due_host_ns() const override;
  int file() const override { return end_.file(); }
  void make_safe() override;
  bool heartbeat_lost() const override;
  void close() override;
  std::vector<std::pair<std::string, std::string>> versions() const override {
    return end_.versions();
  }
  std::vector<std::string> findings() const override;
  const io::CanMonitor& monitor() const { return end_.monitor(); }

 private:
  struct Order {
    std::int64_t due_host_ns;
    io::CanFrame frame;
  };
  void work();
  Result<bool> send(const io::CanFrame& frame);
  void send_zeros();
  Result<Done> send_due(std::int64_t now_host_ns);
  void turn_node(std::int64_t now_host_ns);
  Result<Done> take_in(Arrivals& arrivals);

  CanOptions options_;
  CanEnd end_;
  mutable std::mutex mutex_;  // over all below, and end_'s send()
  std::condition_variable changed_;
  std::deque<Order> orders_;
  std::optional<BusNode> node_;
  VirtualTime virtual_ns_;
  std::deque<io::CanFrame> node_waiting_;                   // its frames, for the controller
  std::map<std::uint32_t, std::uint8_t> next_transfer_id_;  // by identifier, after what went out
  std::int64_t retry_host_ns_ = 0;                          // the controller was full
  std::int64_t heard_host_ns_ = 0, next_safe_ns_ = 0;
  bool safe_ = false, alone_ = false, ending_ = false;
  std::thread thread_;
};

}  // namespace whirl::bench
