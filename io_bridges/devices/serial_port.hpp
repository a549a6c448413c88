// The far end of a serial line: a terminal, a logger, a plan that types commands.
//
//   From the MCU  characters gathered into messages: up to a line end, 64 bytes, or a pause of ten
//                 characters; each handed over with the time of its last stop bit
//   To the MCU    bytes one after another in the port's own format
//   Follows       where it is told to, the MCU's rate from its first character on: so it is where the
//                 line's bytes come from, and go to, somebody whose rate nobody tells (a pseudo-terminal)
//   Findings      a baud rate more than 3 % off, or another format: the characters come as garbage
//                 on copper, here they come whole and the mismatch is told once
#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "io_bridges/devices/bus.hpp"

namespace whirl::io {

class SerialPort : public UartPeer {
 public:
  using Sink = std::function<void(std::span<const std::uint8_t> bytes, Nanoseconds t_ns)>;

  SerialPort(EventQueue& queue, std::string name, const UartFormat& format, FindingSink findings);

  void follow() { follows_ = true; }
  void on_message(Sink sink) { sink_ = std::move(sink); }
  void send_bytes(std::span<const std::uint8_t> bytes, Nanoseconds t_ns);  // no earlier than t_ns
  void receive(const UartByte& byte, const UartFormat& format, Nanoseconds now) override;

 private:
  struct Waiting {
    Nanoseconds t_ns;
    std::uint8_t byte;
  };
  Nanoseconds character_ns() const {
    return static_cast<Nanoseconds>(format_.bits() * 1e9 / format_.baud);
  }
  void hand_over();
  void next_byte();

  EventQueue& queue_;
  std::string name_;
  UartFormat format_;
  FindingSink findings_;
  Sink sink_;
  std::vector<std::uint8_t> message_;
  Nanoseconds last_ns_ = 0;
  std::deque<Waiting> waiting_;
  bool mismatch_told_ = false, follows_ = false;
  Event pause_, byte_due_;
};

}  // namespace whirl::io
