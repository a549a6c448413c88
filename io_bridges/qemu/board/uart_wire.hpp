// A UART between two boards, both ways: the far board's port as the near UART sees it.
//
//   Exact     each character as it was sent, break and format, at the time at which its last stop bit has passed; the
//             receiver samples it at its own rate (io_bridges/devices/uart_sampling.hpp)
//   Latency   one character. The leader's is told as it ends, the follower's as its start bit begins, which the leader knows
//             of in time if it takes no less than latency_ns
//   Faults    of either end's wire act both ways (io_bridges/devices/wire_faults.hpp): both ends see them
//   Findings  a follower's character that takes less: it may come late
//   Left out  levels between characters, and so RTS, CTS and a line that nobody drives; a character that the follower's reset cuts
//             short arrives whole
#pragma once
#include <deque>

#include "io_bridges/devices/early_uart_peer.hpp"
#include "io_bridges/qemu/board/wire_ends.hpp"

namespace whirl::board {

// The follower's UART as the leader's sees it.
class LeaderUart final : public LeaderPort, public io::UartPeer {
 public:
  LeaderUart(LeaderWire& wire, std::uint8_t port, Nanoseconds latency_ns);

  void receive(const io::UartByte& byte, const io::UartFormat& format, Nanoseconds now) override;

 private:
  void edge(const io::WireEdge& edge) override;
  void deliver();

  LeaderWire& wire_;
  std::uint8_t port_;
  std::deque<io::WireEdge> coming_;
  io::Event due_;
};

// And the other way round.
class FollowerUart final : public FollowerPort, public io::EarlyUartPeer {
 public:
  FollowerUart(FollowerWire& wire, std::uint8_t port, std::string name, Nanoseconds latency_ns);

  void begin(const io::UartByte& byte, const io::UartFormat& format, Nanoseconds now,
             Nanoseconds end) override;
  void receive(const io::UartByte&, const io::UartFormat&, Nanoseconds) override {}

 private:
  bool act(const io::WireMessage& message, Nanoseconds now) override;
  io::WireAnswer reply(io::WireAnswer::Clock, Nanoseconds) override { return {}; }  // never asked

  FollowerWire& wire_;
  std::uint8_t port_;
  std::string name_;
  Nanoseconds latency_ns_;
  io::OnceFindings findings_;
};

}  // namespace whirl::board
