// The ends of a board's wires to other boards. The bus master's board leads: for each byte it asks the slave's
// board, whose answer has ACK or byte and when that lets go of the clock. The slave's board follows: it acts as
// the controller on its own bus at the times that it is told, and blocks where it does not know what comes next.
//
//   Exact     START, STOP, addresses, ACK and NACK, bytes, begin and end of stretching, BUSY; SR2 of both
//   Waiting   a leader waits for answers only, a follower for messages only, and posts its answer at the act,
//             when SCL rises, kHeld_ns after, or at its boundary: so none waits for ever
//   Ahead     while it holds the clock a follower runs on, at most kHeld_ns beyond what the leader knows.
//             A master that gives up meanwhile has its STOP seen by so much too late: counted, a finding
//   Events    only where something passes the wire: an event that says no more than "nothing came" would let a board's
//             execution pause there, and by cycles its time then differs: so nor is there one for the end of a hold
//   Faults    of the leader's bus act between master and slave; so both see what they spoil
//   Findings  late messages; a START by the follower; an address at which no far board ever answered
//   Left out  a low SDA on one side as seen from the other: a stuck line is the side's where it is injected, and a
//             slave whose clock is gone (I2cTarget::abandoned) frees nothing here; general call
//   Fetched   ahead: a follower's byte is taken as soon as its clock is free, so its log of a read that the
//             master broke off has one byte more
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io_bridges/devices/bus.hpp"
#include "io_bridges/devices/event_queue.hpp"
#include "io_bridges/devices/i2c_bus.hpp"
#include "io_bridges/link/wire.hpp"

namespace whirl::board {

using io::Nanoseconds;

struct WireSite {
  io::EventQueue& events;
  io::FindingSink finding;
  std::function<void()> closed;  // the run ends: does not return, in a board
};

// A far slave as the master's bus sees it.
class LeaderEnd final : io::I2cTarget {
 public:
  // `ear` repeats what was written and acknowledged: who listens there is a device that the far board takes
  // the place of, and tells what it was sent.
  LeaderEnd(const WireSite& site, io::I2cBus& bus, std::unique_ptr<io::I2cBus> ear,
            std::uint8_t address, io::BoardWire wire);

  void at_boundary(Nanoseconds now);
  void after_boundary(Nanoseconds now);
  void run_ends(Nanoseconds now);

 private:
  bool answers(std::uint8_t address_7bit) const override { return address_7bit == address_; }
  bool start(std::uint8_t address_7bit, bool read, Nanoseconds now) override;
  bool write(std::uint8_t byte, Nanoseconds now) override;
  std::uint8_t read(Nanoseconds now) override;
  void acked(bool ack, Nanoseconds now) override;
  void stop(Nanoseconds) override {}  // on_free tells of all

  void began(Nanoseconds now);
  void ended(Nanoseconds now);
  void post(const io::WireMessage& message);
  io::WireAnswer ask(const io::WireMessage& message);
  void hold(bool low);

  WireSite site_;
  io::I2cBus& bus_;
  std::unique_ptr<io::I2cBus> ear_;
  std::uint8_t address_;
  io::BoardWire wire_;
  io::Event again_;
  int handle_;
  bool held_ = false;
  bool far_at_boundary_ = false;  // and so was nothing more before it
  bool has_next_ = false;
  std::uint8_t next_ = 0;
  std::int64_t addressed_ = 0, acknowledged_ = 0;
};

// The far master as the slave's bus sees it.
class FollowerEnd {
 public:
  static constexpr Nanoseconds kHeld_ns = 50'000;

  FollowerEnd(const WireSite& site, io::I2cBus& bus, io::BoardWire wire);

  void at_boundary(Nanoseconds now);
  void after_boundary(Nanoseconds now, Nanoseconds next);
  void run_ends(Nanoseconds now);
  std::int64_t late() const { return late_; }

 private:
  enum class Next : std::uint8_t { go_on, wait_for_scl, boundary };

  void pause();
  Next act(const io::WireMessage& message, Nanoseconds now);
  void begin(Nanoseconds now);
  void end(Nanoseconds now);
  void count_late(const io::WireMessage& message, Nanoseconds now);
  void answer(io::WireAnswer::Clock clock, Nanoseconds now);
  void clock_rose(Nanoseconds now);

  WireSite site_;
  io::I2cBus& bus_;
  io::BoardWire wire_;
  io::Event pause_, cap_;
  io::WireAnswer answer_;
  Nanoseconds next_boundary_ns_ = 0;
  bool waiting_ = false;  // for SCL: a question is open
  bool ahead_ = false;    // the answer takes the next byte with it
  bool ours_ = false;     // this board was addressed since the START
  bool acting_ = false;   // a START is the far master's
  bool start_told_ = false;
  std::int64_t late_ = 0;
  Nanoseconds latest_ns_ = 0;
};

// All of one board.
class WireEnds {
 public:
  explicit WireEnds(WireSite site);

  void lead(io::I2cBus& bus, std::unique_ptr<io::I2cBus> ear, std::uint8_t address,
            io::BoardWire wire);
  void follow(io::I2cBus& bus, io::BoardWire wire);

  // Before what happened is posted, and after orders until `next` have come.
  void at_boundary(Nanoseconds now);
  void after_boundary(Nanoseconds now, Nanoseconds next);
  void run_ends(Nanoseconds now);

 private:
  WireSite site_;
  std::vector<std::unique_ptr<LeaderEnd>> leaders_;
  std::vector<std::unique_ptr<FollowerEnd>> followers_;
};

}  // namespace whirl::board
