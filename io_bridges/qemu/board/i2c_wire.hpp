// An I2C bus between two boards: its master's end and its slave's.
//
//   Exact     START, STOP, addresses, ACK and NACK, bytes, begin and end of stretching, BUSY; SR2 of both. On a shared
//             wire (wire_ends.hpp) the end of stretching within kLook_ns
//   Findings  a START by the follower; an address at which no far board ever answered
//   Left out  a low SDA on one side as seen from the other: a stuck line is the side's where it is injected, and a
//             slave whose clock is gone (I2cTarget::abandoned) frees nothing here; general call
//   Fetched   ahead: a follower's byte is taken as soon as its clock is free, so its log of a read that the
//             master broke off has one byte more
#pragma once
#include "io_bridges/devices/i2c_bus.hpp"
#include "io_bridges/qemu/board/wire_ends.hpp"

namespace whirl::board {

// The far board's slaves as the master's bus sees them.
class LeaderI2c final : public LeaderPort, io::I2cTarget {
 public:
  LeaderI2c(LeaderWire& wire, std::uint8_t port, io::I2cBus& bus);

  // `ear` repeats what was written there and acknowledged: who listens is a device that the far board takes the
  // place of, and tells what it was sent. It may be null.
  void add(std::uint8_t address, std::unique_ptr<io::I2cBus> ear);

 private:
  struct Seat {
    std::unique_ptr<io::I2cBus> ear;
    std::int64_t addressed = 0, acknowledged = 0;
  };

  bool far_at_boundary() const override { return far_at_boundary_; }
  void after_boundary(Nanoseconds now) override;
  void run_ends(Nanoseconds now) override;

  bool answers(std::uint8_t address_7bit) const override { return seats_.count(address_7bit) != 0; }
  bool start(std::uint8_t address_7bit, bool read, Nanoseconds now) override;
  bool write(std::uint8_t byte, Nanoseconds now) override;
  std::uint8_t read(Nanoseconds now) override;
  void acked(bool ack, Nanoseconds now) override;
  void stop(Nanoseconds) override {}  // on_free tells of all

  void began(Nanoseconds now);
  void ended(Nanoseconds now);
  void post(io::WireMessage message);
  io::WireAnswer ask(io::WireMessage message);
  void hold(bool low);

  LeaderWire& wire_;
  std::uint8_t port_;
  io::EventQueue& events_;
  io::I2cBus& bus_;
  std::map<std::uint8_t, Seat> seats_;  // by address
  Seat* seat_ = nullptr;                // that is addressed
  io::Event again_;
  int handle_;
  bool held_ = false, far_at_boundary_ = false;
  bool has_next_ = false;
  std::uint8_t next_ = 0;
};

// The far master as the slave's bus sees it.
class FollowerI2c final : public FollowerPort {
 public:
  FollowerI2c(FollowerWire& wire, std::uint8_t port, io::I2cBus& bus);

 private:
  bool act(const io::WireMessage& message, Nanoseconds now) override;
  bool held() const override { return !bus_.scl().level(); }
  io::WireAnswer reply(io::WireAnswer::Clock clock, Nanoseconds now) override;

  bool pass(const io::WireMessage& message, Nanoseconds now);
  void begin(Nanoseconds now);
  void end(Nanoseconds now);

  io::I2cBus& bus_;
  io::WireAnswer answer_;
  bool ahead_ = false;   // the answer takes the next byte with it
  bool ours_ = false;    // this board was addressed since the START
  bool acting_ = false;  // a START is the far master's
  bool start_told_ = false;
};

}  // namespace whirl::board
