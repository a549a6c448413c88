#include "harness/target/bench/serial_links.hpp"

#include <array>
#include <cstring>

#include "harness/target/bench/turn_of_bytes.hpp"

namespace whirl::bench {
Result<Done> BoardSerial::open() {
  auto tty = io::Tty::open(link_.path, link_.baud);
  if (!tty) return tty.error();
  tty_ = std::move(tty.value());
  return Done{};
}

bool BoardSerial::take(const io::Reader& order, std::int64_t due_host_ns) {
  if (order.header().kind != io::Kind::uart_frame || order.header().port != link_.uart) {
    return false;
  }
  waiting_.push_back({due_host_ns, {order.payload().begin(), order.payload().end()}});
  return true;
}

std::int64_t BoardSerial::next_due_host_ns() const {
  return waiting_.empty() ? kNever_ns : waiting_.front().due_host_ns;
}

Result<Done> BoardSerial::serve(std::int64_t now_host_ns, Arrivals& arrivals) {
  while (!waiting_.empty() && waiting_.front().due_host_ns <= now_host_ns) {
    if (const auto written = tty_->write(waiting_.front().bytes); !written) return written;
    waiting_.pop_front();
  }
  if (const auto flushed = tty_->flush(); !flushed) return flushed;
  std::array<std::uint8_t, 1024> piece;
  const auto got = tty_->read(piece);
  if (!got) return got.error();
  if (got.value() == 0) return Done{};
  const auto end = piece.begin() + static_cast<std::ptrdiff_t>(got.value());
  arrivals.push_back({now_host_ns, io::Kind::uart_received, link_.uart, {piece.begin(), end}});
  return Done{};
}

std::vector<std::pair<std::string, std::string>> BoardSerial::versions() const {
  return {{"link " + link_.name, link_.path + " at " + std::to_string(link_.baud) + " baud"}};
}

Result<Done> InstrumentLine::open() {
  auto tty = io::Tty::open(instrument_.path, instrument_.baud);
  if (!tty) return tty.error();
  tty_ = std::move(tty.value());
  return Done{};
}

Result<Done> InstrumentLine::serve(std::int64_t now_host_ns, Arrivals& arrivals) {
  return read_turn(*tty_, [&](std::span<const std::uint8_t> piece) {
    cutter_.add(piece, [&](std::string_view line) { read_line(line, now_host_ns, arrivals); });
  });
}

void InstrumentLine::read_line(std::string_view line, std::int64_t now_host_ns,
                               Arrivals& arrivals) {
  const std::vector<double> numbers = io::numbers_of(line);
  ++lines_;
  bool complete = true;
  for (std::size_t i = 0; i < instrument_.readings.size(); ++i) {
    const Reading& reading = instrument_.readings[i];
    const auto column = static_cast<std::size_t>(reading.column - 1);
    if (column >= numbers.size()) {
      complete = false;
      continue;
    }
    const io::InstrumentReading value{(numbers[column] - reading.zero) * reading.scale_SI};
    std::vector<std::uint8_t> payload(sizeof value);
    std::memcpy(payload.data(), &value, sizeof value);
    arrivals.push_back({now_host_ns - instrument_.delay_ns, io::Kind::instrument_reading,
                        static_cast<std::uint16_t>(first_port_ + i), std::move(payload)});
  }
  if (!complete) ++short_;
}

std::vector<std::pair<std::string, std::string>> InstrumentLine::versions() const {
  return {{"instrument " + instrument_.name,
           instrument_.path + " at " + std::to_string(instrument_.baud) + " baud"}};
}

}  // namespace whirl::bench
