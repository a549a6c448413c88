// A virtual board, or several that wires join, that behave as metal: time does not wait for who is at their wires.
//
//   First   of several: I2C and the world around are the first one's
//
//   CAN     frames of an interface of this host go onto the board's bus, and what the board sends comes out there, by
//           the board's can_port
//   Wires   its serial lines on pseudo-terminals, its I2C slave by transfers that wait for their answer, what a load
//           cell and meters would say as lines of text on another pseudo-terminal
//   Pace    of the host's clock, as a pacer holds it; a host that is late is told of in lateness(), from the first byte
//           or frame on that somebody has sent it: before, nobody waits for it
//   Thread  run() is one thread's; transfer() and end() may be called by any other
//   Left out  the wire's own noise; a USB bridge's time, which is its model's
#pragma once
#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "harness/lockstep/lockstep.hpp"
#include "harness/pacing/pacer.hpp"
#include "harness/target/bench/bridge_link.hpp"
#include "io_bridges/serial/pseudo_terminal.hpp"
#include "io_bridges/socketcan/can_port.hpp"

namespace whirl {

struct StandInLine {  // a serial line of a board
  std::uint16_t uart = 1;
  io::PseudoTerminal end;
  std::uint8_t board = 0;  // of several, its place in their list
};

struct StandInOptions {
  double pace = 1.0;
  std::uint16_t i2c = 2;
  std::vector<StandInLine> lines = {};  // at any other nobody is
  std::optional<io::PseudoTerminal> instruments;
  std::uint16_t can_bus = 1;
  std::uint8_t can_board = 0;              // of several, its place in their list
  std::unique_ptr<io::CanPort> can = {};   // none: nobody is on its bus
  std::vector<std::string> told;           // signals of the world, in the order of a line, in SI
  std::int64_t told_every_ns = 2'000'000;  // of virtual time, whole milliseconds
};

class StandIn {
 public:
  StandIn(World& world, Target& board, pacing::HostClock& clock, StandInOptions options);

  // Until end(), or the board ends. Errors  those of the target, and of lockstep
  Result<Done> run();
  void end();

  // Over the board's I2C, as a master on its bus would: waits until it has ended, some milliseconds of virtual
  // time. Errors  host: the board has ended
  Result<bench::TransferOutcome> transfer(const bench::Transfer& transfer);
  // The same without waiting: outcome() is nothing until it is there, and gives it once; a board that has ended answers
  // nothing any more: not acknowledged.
  std::uint32_t begin(const bench::Transfer& transfer);
  std::optional<bench::TransferOutcome> outcome(std::uint32_t number);

  const pacing::Lateness& lateness() const { return pacer_.lateness(); }

 private:
  struct Waiting {
    bench::Transfer transfer;
    std::optional<bench::TransferOutcome> outcome;
  };
  void heard();
  void take_in();
  Result<Done> take_in_can(std::int64_t now_ns);
  void hand_out_can(const io::Reader& passed);
  void hand_out();
  void tell();
  void answer(const io::Reader& reply);

  Lockstep lockstep_;
  pacing::HostClock& clock_;
  pacing::Pacer pacer_;
  StandInOptions options_;
  std::vector<std::size_t> columns_;  // of options_.told
  std::deque<io::CanFrame> to_can_;   // the interface's queue was full
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::uint32_t, Waiting> open_;
  std::vector<std::uint32_t> fresh_;  // not yet given to the board
  std::uint32_t number_ = 0;
  bool heard_ = false;  // somebody is at its wires
  bool ending_ = false, ended_ = false;
};

}  // namespace whirl
