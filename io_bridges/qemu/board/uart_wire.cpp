#include "io_bridges/qemu/board/uart_wire.hpp"

#include <cmath>
#include <utility>

#include "base/check.hpp"

namespace whirl::board {

using io::UartByte;
using io::UartFormat;
using io::WireAct;
using io::WireCharacter;

namespace {

WireCharacter packed(const UartByte& byte, const UartFormat& format) {
  return {.baud = format.baud,
          .byte = byte.value,
          .data_bits = static_cast<std::uint8_t>(format.data_bits),
          .half_stop_bits = static_cast<std::uint8_t>(std::lround(2.0 * format.stop_bits)),
          .parity = format.parity,
          .framing_error = byte.framing_error,
          .noise = byte.noise,
          .is_break = byte.is_break,
          .inverted = format.inverted};
}

UartByte byte_of(const WireCharacter& c) {
  return {c.byte, c.framing_error, c.noise, c.is_break};
}

UartFormat format_of(const WireCharacter& c) {
  return {c.baud, c.data_bits, c.parity, 0.5 * c.half_stop_bits, c.inverted};
}

}  // namespace

LeaderUart::LeaderUart(LeaderWire& wire, std::uint8_t port, Nanoseconds latency_ns)
    : wire_(wire), port_(port), due_(wire.site().events, [this] { deliver(); }) {
  wire_.hear_lines(latency_ns);
}

void LeaderUart::receive(const UartByte& byte, const UartFormat& format, Nanoseconds now) {
  wire_.post({now, WireAct::character, 0, 0, port_, packed(byte, format)});
}

void LeaderUart::edge(const io::WireEdge& edge) {
  coming_.push_back(edge);
  if (!due_.pending()) due_.at(coming_.front().until_ns);
}

void LeaderUart::deliver() {
  const io::WireEdge passed = coming_.front();
  coming_.pop_front();
  if (!coming_.empty()) due_.at(coming_.front().until_ns);
  send(byte_of(passed.character), format_of(passed.character));
}

FollowerUart::FollowerUart(FollowerWire& wire, std::uint8_t port, std::string name,
                           Nanoseconds latency_ns)
    : wire_(wire),
      port_(port),
      name_(std::move(name)),
      latency_ns_(latency_ns),
      findings_(wire.site().finding) {}

void FollowerUart::begin(const UartByte& byte, const UartFormat& format, Nanoseconds now,
                         Nanoseconds end) {
  wire_.tell({.t_ns = now, .port = port_, .until_ns = end, .character = packed(byte, format)});
  if (end - now >= latency_ns_) return;
  findings_.report({now, name_,
                    "a character of " + std::to_string(end - now) + " ns, and the wire is for " +
                        std::to_string(latency_ns_) +
                        " ns at least: it may come late at the other board"});
}

bool FollowerUart::act(const io::WireMessage& message, Nanoseconds) {
  WHIRL_CHECK(message.act == WireAct::character, static_cast<int>(message.act));
  send(byte_of(message.character), format_of(message.character));
  return false;
}

}  // namespace whirl::board
