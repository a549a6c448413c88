// The ends of a board's wires to other boards. The bus master's board leads: for each byte it asks the slave's
// board. The slave's board follows: it acts as the master on its own buses at the times that it is told, and
// blocks where it does not know what comes next. What a bus carries: i2c_wire.hpp, spi_wire.hpp, uart_wire.hpp, level_wire.hpp. A CAN
// bus has no master, and wires of its own: can_wire.hpp.
//
//   Waiting   a leader waits for answers and marks only, a follower for messages only, and posts its answer at the
//             act, when the clock is free, kHeld_ns after, or at its boundary: so none waits for ever
//   Ahead     while a follower holds an I2C clock and nothing else is on its wire it runs on, at most kHeld_ns beyond what
//             the leader knows. A master that gives up meanwhile has its STOP seen by so much too late: counted, a finding
//   Shared    a follower with several buses on its wire never runs ahead, for what comes on another one would be
//             late: the leader looks each kLook_ns whether the clock is free, and sees it by so much too late
//   Lines     from follower to leader have a latency that the plan states. Half of it is the grain at which the leader
//             asks for what changed, and each has until the next one to come there: so both run at the same time
//   Events    only where something passes the wire: an event that says no more than "nothing came" would let a board's
//             execution pause there, and by cycles its time then differs: so nor is there one for the end of a hold
//   Faults    of the leader's bus act between master and slave; so both see what they spoil
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "io_bridges/qemu/board/can_wire.hpp"
#include "io_bridges/qemu/board/wire_site.hpp"

namespace whirl::board {

inline constexpr std::size_t kMost_ports = 16;

// What of one bus is at the master's end.
class LeaderPort {
 public:
  virtual ~LeaderPort() = default;
  virtual bool far_at_boundary() const { return false; }  // and so was nothing more before it
  virtual void after_boundary(Nanoseconds /*now*/) {}
  virtual void run_ends(Nanoseconds /*now*/) {}
  virtual void edge(const io::WireEdge& /*edge*/) {}  // of the far board's line or UART
};

class LeaderWire {
 public:
  LeaderWire(const WireSite& site, io::BoardWire wire);

  const WireSite& site() const { return site_; }
  // The port of that number; made by `make` where there is none.
  template <typename Port, typename... Args>
  Port& port(std::uint8_t number, Args&&... args) {
    auto& place = ports_.at(number);
    if (place == nullptr) {
      place = std::make_unique<Port>(*this, number, std::forward<Args>(args)...);
    }
    return static_cast<Port&>(*place);
  }

  void post(const io::WireMessage& message);
  io::WireAnswer ask(const io::WireMessage& message);
  // The far board's lines are heard, by the shortest latency that is asked for.
  void hear_lines(Nanoseconds latency_ns);

  void at_boundary(Nanoseconds now);
  void after_boundary(Nanoseconds now);
  void run_ends(Nanoseconds now);

 private:
  void mark();

  WireSite site_;
  io::BoardWire wire_;
  io::Event mark_;
  Nanoseconds grain_ns_ = 0;
  bool marked_ = false;
  std::array<std::unique_ptr<LeaderPort>, kMost_ports> ports_;
};

// What of one bus is at the slave's end.
class FollowerPort {
 public:
  virtual ~FollowerPort() = default;
  // What came acts; true: it is a question.
  virtual bool act(const io::WireMessage& message, Nanoseconds now) = 0;
  virtual bool held() const { return false; }  // the answer waits for the clock
  // Its clock is of who calls, and so is t_ns where that is held.
  virtual io::WireAnswer reply(io::WireAnswer::Clock clock, Nanoseconds now) = 0;
};

class FollowerWire {
 public:
  static constexpr Nanoseconds kHeld_ns = 50'000, kLook_ns = 1000;

  // shared: there are several buses on it.
  FollowerWire(const WireSite& site, io::BoardWire wire, bool shared);

  const WireSite& site() const { return site_; }
  template <typename Port, typename... Args>
  Port& port(std::uint8_t number, Args&&... args) {
    auto& place = ports_.at(number);
    place = std::make_unique<Port>(*this, number, std::forward<Args>(args)...);
    return static_cast<Port&>(*place);
  }

  void tell(const io::WireEdge& edge) { wire_.tell(edge); }
  void clock_rose(const FollowerPort& port, Nanoseconds now);

  void at_boundary(Nanoseconds now);
  void after_boundary(Nanoseconds now, Nanoseconds next);
  void run_ends(Nanoseconds now);

 private:
  void pause();
  void take(const io::WireMessage& message, Nanoseconds now);
  void count_late(const io::WireMessage& message, Nanoseconds now);
  void answer(io::WireAnswer::Clock clock, Nanoseconds now);

  WireSite site_;
  io::BoardWire wire_;
  bool shared_;
  io::Event pause_, cap_;
  Nanoseconds next_boundary_ns_ = 0;
  std::array<std::unique_ptr<FollowerPort>, kMost_ports> ports_;
  FollowerPort* asked_ = nullptr;  // a question is open
  bool waiting_ = false;           // for its clock
  std::int64_t late_ = 0;
  Nanoseconds latest_ns_ = 0;
};

// All of one board.
class WireEnds {
 public:
  explicit WireEnds(WireSite site);

  // The wire of that descriptor, which is attached to when it is first asked for. Not null.
  Result<LeaderWire*> lead(int fd);
  Result<FollowerWire*> follow(int fd, bool shared);
  // Of CAN: another board on a bus that this one's arbitrates (see CanLeader::add), and a bus that another one's does.
  Result<Done> arbitrate(int fd, io::CanBus& bus, const std::string& name, int number,
                         std::unique_ptr<CanEar> ear);
  Result<Done> share(int fd, io::CanBus& bus);

  // Before what happened is posted, and after orders until `next` have come.
  void at_boundary(Nanoseconds now);
  void after_boundary(Nanoseconds now, Nanoseconds next);
  void run_ends(Nanoseconds now);

 private:
  WireSite site_;
  std::map<int, std::unique_ptr<LeaderWire>> leaders_;  // by descriptor
  std::map<int, std::unique_ptr<FollowerWire>> followers_;
  std::vector<std::unique_ptr<CanLeader>> arbiters_;  // of each bus
  std::vector<std::unique_ptr<CanFollower>> shares_;
};

}  // namespace whirl::board
