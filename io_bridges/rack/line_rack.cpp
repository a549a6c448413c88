#include "io_bridges/rack/line_rack.hpp"

namespace whirl::rack {

void LineRack::give(std::span<const std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes) {
    for (io::UartPeer* peer : peers_) peer->receive({.value = byte}, format_, events().now());
  }
}

bool LineRack::join_uart(int /*number*/, io::UartPeer& peer) {
  peer.join([this](const io::UartByte& byte, const io::UartFormat& format) {
    heard_(byte.value, format.baud);
  });
  if (const auto* rated = dynamic_cast<const io::RatedUartPeer*>(&peer)) rated_ = rated;
  peers_.push_back(&peer);
  return true;
}

}  // namespace whirl::rack
