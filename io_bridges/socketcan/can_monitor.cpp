#include "io_bridges/socketcan/can_monitor.hpp"

#include <algorithm>
#include <cstdio>

namespace whirl::io {

void CanMonitor::on_arrival(const CanArrival& arrival) {
  counts_.dropped += arrival.dropped;
  if (!arrival.trouble) {
    ++(arrival.own ? counts_.sent : counts_.received);
    return count(arrival.frame, arrival.host_ns);
  }
  const CanTrouble& t = *arrival.trouble;
  ++counts_.error_frames;
  counts_.bus_off += t.bus_off;
  counts_.restarted += t.restarted;
  counts_.no_acknowledge += t.no_acknowledge;
  counts_.lost_arbitration += t.lost_arbitration;
  counts_.bus_errors += t.protocol || t.bus_error;
  counts_.overflows += t.receive_overflow || t.transmit_overflow;
  if (t.state) counts_.state = *t.state;
}

void CanMonitor::count(const CanFrame& frame, std::int64_t host_ns) {
  const int bytes = frame.remote ? 0 : frame.length;
  const auto least = static_cast<std::uint64_t>(bits_unstuffed(frame.extended, bytes));
  const auto most = static_cast<std::uint64_t>(bits_stuffed_at_most(frame.extended, bytes));
  least_bits_ += least;
  most_bits_ += most;
  const std::int64_t second = host_ns / 1'000'000'000;
  if (second > second_) {
    if (second_ >= 0 && bit_rate_bps_ != 0) {
      const double rate = bit_rate_bps_;
      fullest_.least = std::max(fullest_.least, static_cast<double>(second_least_) / rate);
      fullest_.most = std::max(fullest_.most, static_cast<double>(second_most_) / rate);
    }
    second_ = second;
    second_least_ = second_most_ = 0;
  }
  second_least_ += least;
  second_most_ += most;
}

CanMonitor::Load CanMonitor::load_between(std::int64_t begin_ns, std::int64_t end_ns) const {
  if (bit_rate_bps_ == 0 || end_ns <= begin_ns) return {};
  const double bits = static_cast<double>(end_ns - begin_ns) * 1e-9 * bit_rate_bps_;
  return {static_cast<double>(least_bits_) / bits, static_cast<double>(most_bits_) / bits};
}

std::string CanMonitor::text() const {
  const auto n = [](std::uint64_t count) { return static_cast<unsigned long long>(count); };
  char line[400];
  std::snprintf(line, sizeof line,
                "%llu frames in, %llu out, %llu lost by this host, %llu waited; %llu error frames "
                "(%llu on the bus, %llu unacknowledged, %llu arbitrations lost, %llu overflows), "
                "%llu times bus-off, %llu restarts",
                n(counts_.received), n(counts_.sent), n(counts_.dropped), n(counts_.queue_full),
                n(counts_.error_frames), n(counts_.bus_errors), n(counts_.no_acknowledge),
                n(counts_.lost_arbitration), n(counts_.overflows), n(counts_.bus_off),
                n(counts_.restarted));
  return line;
}

}  // namespace whirl::io
