// What has passed a CAN port: counts, trouble by its kind, how full the bus was.
//
//   Load   lower and upper bound, for stuff bits are not counted one by one: without any, and with the most that a
//          frame of its length can have. Frames of all nodes count, but those that failed do not show
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "io_bridges/socketcan/can_port.hpp"

namespace whirl::io {

struct CanCounts {
  std::uint64_t received = 0, sent = 0;  // sent: and passed
  std::uint64_t dropped = 0;             // by the kernel: we were too slow
  std::uint64_t queue_full = 0;          // times that a frame had to wait for the controller
  std::uint64_t error_frames = 0;
  std::uint64_t bus_off = 0, restarted = 0, no_acknowledge = 0, lost_arbitration = 0;
  std::uint64_t bus_errors = 0, overflows = 0;
  CanBusState state = CanBusState::unknown;  // as last told
};

class CanMonitor {
 public:
  // bit_rate_bps 0: no load can be told (virtual).
  explicit CanMonitor(std::uint32_t bit_rate_bps) : bit_rate_bps_(bit_rate_bps) {}

  void on_arrival(const CanArrival& arrival);
  void on_queue_full() { ++counts_.queue_full; }
  const CanCounts& counts() const { return counts_; }

  struct Load {
    double least = 0, most = 0;  // share of the time
  };
  Load load_between(std::int64_t begin_ns, std::int64_t end_ns) const;  // of the whole run
  // Of the fullest whole second that has passed.
  const Load& fullest_second() const { return fullest_; }
  std::string text() const;  // one line

 private:
  void count(const CanFrame& frame, std::int64_t host_ns);

  std::uint32_t bit_rate_bps_;
  CanCounts counts_;
  std::uint64_t least_bits_ = 0, most_bits_ = 0;
  std::int64_t second_ = -1;  // of the host's clock
  std::uint64_t second_least_ = 0, second_most_ = 0;
  Load fullest_;
};

}  // namespace whirl::io
