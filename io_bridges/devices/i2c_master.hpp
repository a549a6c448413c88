// An I2C master that is not an MCU: a stand that commands a controller, a USB bridge.
//
//   Does     one transfer at a time: START, address, bytes out; or address, bytes in; or both with a
//            repeated START between; STOP. One event per byte
//   Clock    a byte neither begins nor ends while a target holds SCL low
//   Gives up when the bus is not free, or SCL is held, longer than the timeout. Without a clock there
//            is no STOP: it lets go of the lines, and its next START is a repeated one to the targets
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "io_bridges/devices/event_queue.hpp"
#include "io_bridges/devices/i2c_bus.hpp"

namespace whirl::io {

struct I2cRequest {
  std::uint8_t address = 0;
  std::vector<std::uint8_t> write;  // may be empty
  int read = 0;                     // bytes to read after it
};

struct I2cReply {
  bool timed_out = false;
  bool acked = false;               // every address and written byte was acknowledged
  std::vector<std::uint8_t> bytes;  // read
  Nanoseconds stretched_ns = 0;     // the longest that SCL was held between two bytes
  Nanoseconds stop_ns = 0;
};

class I2cMaster {
 public:
  using Done = std::function<void(const I2cReply&)>;

  I2cMaster(EventQueue& queue, I2cBus& bus, double rate_Hz,
            Nanoseconds timeout_ns = 25'000'000);  // 25 ms: SMBus's limit

  bool busy() const { return phase_ != Phase::idle; }
  // Pre: !busy(). `done` comes with the STOP.
  void transfer(I2cRequest request, Done done);

 private:
  enum class Phase : std::uint8_t { idle, starting, addressing, writing, reading, stopping };

  void step();
  void clock_may_run();
  bool may_run();
  void hold();
  void give_up();
  void bits(Phase phase, int count);
  void address_sent();
  void next();
  void finish();

  EventQueue& queue_;
  I2cBus& bus_;
  double bit_ns_;
  Nanoseconds timeout_ns_;
  Event step_, timeout_;
  Phase phase_ = Phase::idle;
  bool reading_ = false;    // the running half
  bool owns_ = false;       // between our START and STOP
  bool abandoned_ = false;  // our START has had no STOP
  bool waits_ = false;
  bool resumes_ = false;  // waits inside a byte, not before it
  int count_ = 0;         // bits of the step that waits
  Nanoseconds waits_since_ = 0;
  std::size_t written_ = 0;
  I2cRequest request_;
  I2cReply reply_;
  Done done_;
};

}  // namespace whirl::io
