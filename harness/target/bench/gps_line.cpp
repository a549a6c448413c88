#include "harness/target/bench/gps_line.hpp"

#include <algorithm>
#include <cmath>

#include "io_bridges/board_description/line_part.hpp"

namespace whirl::bench {

GpsLine::GpsLine(LinePartOptions options)
    : SerialRackLink(options, "a GPS receiver", {}, is_gps), options_(std::move(options)) {}

Result<Done> GpsLine::open() {
  const auto built =
      build(options_.board, options_.types, "usart" + std::to_string(options_.link.uart));
  if (!built) return built;
  if (const auto opened = open_line(io::TtyFrame::n81, rack_.baud()); !opened) return opened;
  baud_ = rack_.baud();
  rack_.set_baud(baud_);
  return Done{};
}

void GpsLine::make_safe() {
  SerialRackLink::make_safe();
  pieces_.clear();
}

void GpsLine::hear(std::uint8_t byte, double baud) {
  if (pieces_.empty() || pieces_.back().baud != baud) pieces_.push_back({baud, {}});
  pieces_.back().bytes.push_back(byte);
}

bool GpsLine::rests(std::int64_t now_host_ns) const {
  return now_host_ns >= rested_host_ns_ && tty_->unsent_B() == 0;
}

Result<Done> GpsLine::set_baud(double baud) {
  baud_ = baud;
  rack_.set_baud(baud);
  return tty_->set_baud(static_cast<int>(std::lround(baud)));
}

Result<Done> GpsLine::send_waiting(std::int64_t now_host_ns) {
  if (const auto flushed = tty_->flush(); !flushed) return flushed;
  if (next_baud() != baud_ && rests(now_host_ns)) {
    if (const auto set = set_baud(next_baud()); !set) return set;
  }
  for (; !pieces_.empty() && pieces_.front().baud == baud_; pieces_.pop_front()) {
    const std::vector<std::uint8_t>& bytes = pieces_.front().bytes;
    const double line_ns =
        static_cast<double>(bytes.size()) * io::UartFormat{}.bits() * 1e9 / baud_;
    const std::int64_t begin_ns = std::max(now_host_ns, rested_host_ns_ - kRest_ns);
    rested_host_ns_ = begin_ns + std::llround(line_ns) + kRest_ns;
    if (const auto written = tty_->write(bytes); !written) return written;
  }
  return Done{};
}

std::int64_t GpsLine::next_due_host_ns() const {
  const std::int64_t due_ns = RackLink::next_due_host_ns();
  return next_baud() == baud_ ? due_ns : std::min(due_ns, rested_host_ns_);
}

}  // namespace whirl::bench
