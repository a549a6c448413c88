#include "io_bridges/devices/serial_port.hpp"

#include <algorithm>
#include <cmath>

namespace whirl::io {

namespace {

constexpr std::size_t kLongest = 64;
constexpr int kPause_characters = 10;
constexpr double kBaud_tolerance = 0.03;

}  // namespace

SerialPort::SerialPort(EventQueue& queue, std::string name, const UartFormat& format,
                       FindingSink findings)
    : queue_(queue),
      name_(std::move(name)),
      format_(format),
      findings_(std::move(findings)),
      pause_(queue, [this] { hand_over(); }),
      byte_due_(queue, [this] { next_byte(); }) {}

void SerialPort::receive(const UartByte& byte, const UartFormat& format, Nanoseconds now) {
  if (follows_) format_.baud = format.baud;
  const bool fits = std::abs(format.baud - format_.baud) <= kBaud_tolerance * format_.baud &&
                    format.data_bits == format_.data_bits && format.parity == format_.parity;
  if (!fits && !mismatch_told_ && findings_) {
    mismatch_told_ = true;
    findings_({now, name_,
               "sent to at " + std::to_string(std::lround(format.baud)) +
                   " baud, but it listens at " + std::to_string(std::lround(format_.baud)) +
                   (format_.parity == 'N' ? " 8N1" : " 8E2")});
  }
  message_.push_back(byte.value);
  last_ns_ = now;
  if (byte.value == '\n' || message_.size() >= kLongest) {
    hand_over();
  } else {
    pause_.at(now + kPause_characters * character_ns());
  }
}

void SerialPort::hand_over() {
  pause_.cancel();
  if (sink_ && !message_.empty()) sink_(message_, last_ns_);
  message_.clear();
}

void SerialPort::send_bytes(std::span<const std::uint8_t> bytes, Nanoseconds t_ns) {
  for (const std::uint8_t byte : bytes) waiting_.push_back({t_ns, byte});
  if (!byte_due_.pending() && !waiting_.empty()) {
    byte_due_.at(std::max(queue_.now(), waiting_.front().t_ns) + character_ns());
  }
}

void SerialPort::next_byte() {
  const UartByte byte{waiting_.front().byte, false, false, false};
  waiting_.pop_front();
  if (!waiting_.empty()) {
    byte_due_.at(std::max(queue_.now(), waiting_.front().t_ns) + character_ns());
  }
  send(byte, format_);
}

}  // namespace whirl::io
