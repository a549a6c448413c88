#include "io_bridges/qemu/board/level_wire.hpp"

namespace whirl::board {

LeaderLevel::LeaderLevel(LeaderWire& wire, std::uint8_t /*port*/, Nanoseconds latency_ns)
    : latency_ns_(latency_ns) {
  wire.hear_lines(latency_ns_);
}

void LeaderLevel::edge(const io::WireEdge& edge) {
  coming_.emplace_back(edge.t_ns + latency_ns_, edge.level_V);
}

double LeaderLevel::volts(Nanoseconds now) {
  while (!coming_.empty() && coming_.front().first <= now) {
    level_V_ = coming_.front().second;
    coming_.pop_front();
  }
  return level_V_;
}

FollowerLevel::FollowerLevel(FollowerWire& wire, std::uint8_t port) : wire_(wire), port_(port) {}

void FollowerLevel::put(double level_V) {
  wire_.tell({.t_ns = wire_.site().events.now(), .port = port_, .level_V = level_V});
}

}  // namespace whirl::board
