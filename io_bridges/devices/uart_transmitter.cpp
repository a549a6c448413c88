#include "io_bridges/devices/uart_transmitter.hpp"

#include <cmath>

namespace whirl::io {

UartTransmitter::UartTransmitter(EventQueue& queue, const UartFormat& format, UartPeer::Sink sink)
    : format_(format), sink_(std::move(sink)), passed_(queue, [this] { sent(); }) {}

Nanoseconds UartTransmitter::character_ns() const {
  return std::llround(format_.bits() * 1e9 / format_.baud);
}

void UartTransmitter::add(std::span<const std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes) waiting_.push_back({.byte = byte});
  start();
}

void UartTransmitter::change_format(const UartFormat& format) {
  waiting_.push_back({.is_format = true, .format = format});
  start();
}

void UartTransmitter::start() {
  if (passed_.pending()) return;
  for (; !waiting_.empty() && waiting_.front().is_format; waiting_.pop_front()) {
    format_ = waiting_.front().format;
  }
  if (!waiting_.empty()) passed_.in(character_ns());
}

void UartTransmitter::sent() {
  const UartByte byte{.value = waiting_.front().byte};
  const UartFormat format = format_;
  waiting_.pop_front();
  start();
  sink_(byte, format);
}

}  // namespace whirl::io
