// The I2C engine inside a bridge's chip: one transfer on an I2cBus, a byte at a time, so that the chip may ask how
// far it is.
//
//   Write   bytes are fed as the chip gets them; the clock waits where none is there yet
//   Read    at most `room` bytes ahead of what the chip has taken; the clock waits there too
//   Hold    a write without STOP keeps the bus; the next transfer begins with a repeated START
//   Stuck   the bus is not free, or SCL is low, for 25 ms (SMBus's limit)
//   Carried  with a carrier in place of the bus: a transfer begins when all its bytes are there, and ends as a whole;
//            which byte was refused is not known then: the address
//   Left out real arbitration: lose_next() makes the next START lose
#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "io_bridges/devices/event_queue.hpp"
#include "io_bridges/devices/i2c_bus.hpp"
#include "io_bridges/hid/emulated/i2c_carrier.hpp"

namespace whirl::io {

class WireEngine {
 public:
  enum class State : std::uint8_t {
    idle,
    starting,
    addressing,
    writing,
    held,
    reading,
    stopping,
    address_nack,
    data_nack,
    stuck,
    lost
  };

  WireEngine(EventQueue& queue, I2cBus& bus, std::size_t room)
      : queue_(queue), bus_(&bus), step_(queue, [this] { step(); }), room_(room) {}
  WireEngine(EventQueue& queue, I2cCarrier& carrier, std::size_t room)
      : queue_(queue), carrier_(&carrier), step_(queue, [this] { ask_carrier(); }), room_(room) {}

  void set_rate(double rate_Hz) { bit_ns_ = 1e9 / rate_Hz; }
  void on_end(std::function<void()> end) {
    end_ = std::move(end);
  }  // told when a transfer has ended, or holds

  bool ready() const {
    return state_ != State::starting && state_ != State::addressing && state_ != State::writing &&
           state_ != State::reading && state_ != State::stopping;
  }
  // Pre: ready().
  void write(std::uint8_t address, std::size_t total, bool stop);
  void read(std::uint8_t address, std::size_t total);
  void feed(std::span<const std::uint8_t> bytes);
  std::vector<std::uint8_t> take(std::size_t most);
  void cancel();  // STOP where it holds the bus; idle
  void lose_next() { lose_ = true; }

  State state() const { return state_; }
  std::size_t passed() const { return passed_; }  // acknowledged or received bytes of this transfer
  std::size_t total() const { return total_; }
  std::size_t waiting() const { return carrier_ == nullptr ? to_write_.size() : 0; }
  std::size_t received() const { return received_.size(); }
  bool scl() { return bus_ == nullptr || bus_->scl().level(); }
  bool sda() { return bus_ == nullptr || bus_->sda().level(); }

 private:
  void begin(std::uint8_t address, std::size_t total);
  void step();
  void next();
  void finish(State with);
  void rest(State in);
  bool blocked();
  void carry_write();
  void ask_carrier();
  void after_bits(int count) { step_.in(static_cast<Nanoseconds>(count * bit_ns_)); }

  EventQueue& queue_;
  I2cBus* bus_ = nullptr;
  I2cCarrier* carrier_ = nullptr;
  Event step_;
  std::size_t room_;
  std::function<void()> end_;
  double bit_ns_ = 1e4;
  State state_ = State::idle, final_ = State::idle;
  bool holds_ = false, stop_ = true, reading_ = false, paused_ = false, lose_ = false;
  std::uint8_t address_ = 0;
  std::size_t passed_ = 0, total_ = 0;
  Nanoseconds blocked_since_ = -1;
  std::deque<std::uint8_t> to_write_, received_;
};

}  // namespace whirl::io
