// The devices of a board at the other end of one of its serial lines, without the board (far_rack.hpp).
//
//   Line   whichever it is: bytes of the microcontroller's go to all that have joined one. Ours are heard afar with their
//          last stop bit, at the device's own rate; on copper they take their time again
//   Rate   of the microcontroller's bytes: as the line's other end reads them, which may be another than the device's
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "io_bridges/devices/rated_uart_peer.hpp"
#include "io_bridges/rack/far_rack.hpp"

namespace whirl::rack {

class LineRack final : public FarRack {
 public:
  using ByteSink = std::function<void(std::uint8_t byte, double baud)>;
  using Choice = std::function<bool(const BoardDevice&)>;
  // format: of the microcontroller's bytes. heard: what it hears.
  LineRack(io::UartFormat format, std::uint64_t seed, Choice carries, ByteSink heard)
      : FarRack(seed), format_(format), carries_(std::move(carries)), heard_(std::move(heard)) {}

  void give(std::span<const std::uint8_t> bytes);      // the microcontroller's
  void set_baud(double baud) { format_.baud = baud; }  // of those from here on
  // To which a device has set itself. Pre: one of its kind (rated_uart_peer.hpp) is there.
  double baud() const { return rated_->baud(); }

 private:
  bool carries(const BoardDevice& device) const override { return carries_(device); }
  bool join_uart(int number, io::UartPeer& peer) override;

  io::UartFormat format_;
  Choice carries_;
  ByteSink heard_;
  std::vector<io::UartPeer*> peers_;
  const io::RatedUartPeer* rated_ = nullptr;
};

}  // namespace whirl::rack
