// A throttle source on the board's I2C bus: does the harness's orders one after another, each not
// before its time, and tells how each went. What comes 10 ms late because the bus was stuck is not
// sent any more: it counts as timed out.
#pragma once
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "io_bridges/devices/event_queue.hpp"
#include "io_bridges/devices/i2c_master.hpp"
#include "io_bridges/messages/messages.hpp"

namespace whirl::rack {

class I2cOrders {
 public:
  I2cOrders(io::EventQueue& events, io::I2cBus& bus, double rate_Hz, std::uint16_t port,
            io::Batch& happened);

  void add(const io::I2cOrder& order, std::span<const std::uint8_t> bytes, io::Nanoseconds t_ns);

 private:
  struct Waiting {
    io::Nanoseconds t_ns = 0;
    std::uint32_t number = 0;
    io::I2cRequest request;
  };
  void next();
  void report(std::uint32_t number, const io::I2cReply& reply);
  void done(std::uint32_t number, const io::I2cReply& reply);

  io::EventQueue& events_;
  io::I2cMaster master_;
  io::Event due_;
  std::uint16_t port_;
  io::Batch& happened_;
  std::deque<Waiting> waiting_;
};

}  // namespace whirl::rack
