// The ends of wires to other boards on a rack: a far board in a device's place, and a bus on which another board is
// the master.
#pragma once
#include <functional>
#include <memory>

#include "base/result.hpp"
#include "io_bridges/board_description/board_description.hpp"
#include "io_bridges/devices/i2c_bus.hpp"
#include "io_bridges/qemu/board/wire_ends.hpp"
#include "io_bridges/rack/device_type.hpp"

namespace whirl::board {

// What listens in a device's place to what another board is sent there, by its bus.
struct Ear {
  std::unique_ptr<io::I2cBus> i2c;
  std::unique_ptr<CanEar> can;
};

class FarEnds {
 public:
  using JoinUart = std::function<bool(int number, io::UartPeer& peer)>;

  // `wires` may be null where nothing is led or followed. join_uart: with faults that act both ways.
  FarEnds(rack::Rack& rack, WireEnds* wires, JoinUart join_uart)
      : rack_(rack), wires_(wires), join_uart_(std::move(join_uart)) {}

  // Errors  bad_input: no device on a bus of this part that has wires
  Result<Done> lead(const BoardDevice& device, int number, const WireEnd& end, Ear ear);
  // Or, of CAN, arbitrates. Errors  bad_input: no such bus or pin; a UART that a device is on
  Result<Done> follow(const WireEnd& end);

 private:
  Result<Done> follow_can(const WireEnd& end);
  bool lead_spi(LeaderWire& wire, const BoardDevice& device, int number, const WireEnd& end);
  Result<Done> follow_spi(FollowerWire& wire, const WireEnd& end, io::SpiSlave& slave);
  io::Wire* pin_of(const BoardDevice& device, const char* key);  // null: it has none
  void tell_ready(io::Wire& ready, int number);

  rack::Rack& rack_;
  WireEnds* wires_;
  JoinUart join_uart_;
  int boards_ = 0;  // on buses that this one arbitrates, in no device's place
};

}  // namespace whirl::board
