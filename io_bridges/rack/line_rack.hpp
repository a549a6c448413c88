// The devices of a board at the other end of one of its serial lines, without the board (far_rack.hpp).
//
//   Line   whichever it is: bytes of the microcontroller's go to all that have joined one. Ours are heard afar with their
//          last stop bit, at the device's own rate; on copper they take their time again
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "io_bridges/rack/far_rack.hpp"

namespace whirl::rack {

class LineRack final : public FarRack {
 public:
  using ByteSink = std::function<void(std::uint8_t)>;
  using Choice = std::function<bool(const BoardDevice&)>;
  // format: of the microcontroller's bytes. heard: what it hears.
  LineRack(io::UartFormat format, std::uint64_t seed, Choice carries, ByteSink heard)
      : FarRack(seed), format_(format), carries_(std::move(carries)), heard_(std::move(heard)) {}

  void give(std::span<const std::uint8_t> bytes);  // the microcontroller's

 private:
  bool carries(const BoardDevice& device) const override { return carries_(device); }
  bool join_uart(int number, io::UartPeer& peer) override;

  io::UartFormat format_;
  Choice carries_;
  ByteSink heard_;
  std::vector<io::UartPeer*> peers_;
};

}  // namespace whirl::rack
