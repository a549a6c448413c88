// An I2C bus: SDA and SCL as wires, the targets that hang on them, and the faults of the wire.
//
//   The controller (an MCU's I2C peripheral) calls start/address/write/read/stop at the times at
//   which the condition or the byte's ninth clock has passed. It asks idle() before a START: SDA or
//   SCL held low by a fault (or by GPIO) keeps the bus busy, as on copper. Recovery: a target that
//   holds SDA after a lost clock lets go when SCL has been pulsed by GPIO as often as the fault
//   says (nine is usual). While SDA is held low, every bit reads 0: bytes are 0x00 and every
//   acknowledge slot looks like an ACK.
//   Stretching: a target that needs time (an MCU) drives scl() low itself; the controller begins no
//   byte and ends none while SCL is low. Of a hold whose end is known beforehand only that is said,
//   hold_until(): an event at that time would stop the controller's core there, in the middle of what it
//   does, and its time by cycles would then differ.
#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io_bridges/devices/bus.hpp"
#include "io_bridges/devices/wire.hpp"

namespace whirl::io {

// One transaction from START to STOP (or repeated START), for logs and timing verdicts.
struct I2cTransaction {
  Nanoseconds start_ns = 0, stop_ns = 0;
  std::uint8_t address = 0;
  bool read = false;
  bool address_acked = false;
  bool repeated_start = false;  // ended by a repeated START instead of STOP
  bool all_acked = true;        // every written byte was acknowledged
  std::vector<std::uint8_t> bytes;
  std::vector<Nanoseconds> passed_ns;  // the ninth clock of each
};

// Faults that act on bytes and acknowledge bits on their way. Asked only where a target answers;
// index counts the data bytes of the transaction from 0, -1 is the address byte.
class I2cFaults {
 public:
  virtual ~I2cFaults() = default;
  virtual bool deaf(std::uint8_t address, Nanoseconds now) = 0;  // the target hears nothing
  virtual bool ack(std::uint8_t address, int index, Nanoseconds now) = 0;  // may an ACK pass?
  virtual std::uint8_t byte(std::uint8_t address, int index, std::uint8_t value,
                            Nanoseconds now) = 0;                          // what really passes
  virtual Nanoseconds stretch(std::uint8_t address, Nanoseconds now) = 0;  // SCL held after address
};

class I2cBus {
 public:
  explicit I2cBus(std::string name);

  void add(I2cTarget& target) { targets_.push_back(&target); }
  void set_faults(I2cFaults* faults) { faults_ = faults; }
  void on_transaction(std::function<void(const I2cTransaction&)> log) { log_ = std::move(log); }

  Wire& sda() { return sda_; }
  Wire& scl() { return scl_; }
  const std::string& name() const { return name_; }
  bool idle() const { return !busy_ && sda_.level() && scl_.level(); }
  bool busy() const { return busy_; }
  // A target holds SCL low until then: the controller clocks its next bit or condition no earlier.
  Nanoseconds released_ns() const { return released_ns_; }
  void hold_until(Nanoseconds time) { released_ns_ = std::max(released_ns_, time); }

  // Controller side. start() opens a transaction, or ends the running one by a repeated START.
  void start(Nanoseconds now);
  bool address(std::uint8_t address_7bit, bool read, Nanoseconds now);  // returns ACK
  bool write(std::uint8_t byte, Nanoseconds now);                       // returns ACK
  // One byte towards the controller: fetch() as its first bit is due, answer() at the ninth clock.
  std::uint8_t fetch(Nanoseconds now);
  void answer(bool ack, Nanoseconds now);
  std::uint8_t read(bool ack, Nanoseconds now);  // both at once
  void stop(Nanoseconds now);
  // A STOP of what was meant for targets that are not on this side of the wire: not in the log.
  void stop_unseen(Nanoseconds now);
  // The controller has let go of both lines without a STOP: the bus stays busy until the next one.
  void abandon(Nanoseconds now);
  // Told at each STOP: a controller that waits for a free bus may try again.
  void on_free(std::function<void(Nanoseconds)> free) { on_free_.push_back(std::move(free)); }
  // Told at each START, repeated ones too.
  void on_start(std::function<void(Nanoseconds)> start) { on_start_.push_back(std::move(start)); }

 private:
  void finish(bool repeated, Nanoseconds now);
  void set_free(Nanoseconds now);
  void byte_passed(Nanoseconds now);
  int index() const { return static_cast<int>(current_.bytes.size()); }

  std::string name_;
  Wire sda_, scl_;
  std::vector<I2cTarget*> targets_;
  std::vector<I2cTarget*> addressed_;
  I2cFaults* faults_ = nullptr;
  std::function<void(const I2cTransaction&)> log_;
  std::vector<std::function<void(Nanoseconds)>> on_free_, on_start_;
  I2cTransaction current_;
  Nanoseconds released_ns_ = 0;
  bool busy_ = false;
};

}  // namespace whirl::io
