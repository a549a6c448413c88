// A DroneCAN node with an HMC5883L: its program lets it measure at 75 Hz and sends each on CAN.
//
//   Part     register by register, on an I2C of the node's own, with its faults (hmc5883l.hpp)
//   Sends    MagneticFieldStrength2 in the body's axes, 200 us after data-ready (six bytes and the address at
//            400 kHz). An axis that overflowed (-4096): nothing
//   Silence  100 ms without data: the part is set up anew
#pragma once
#include "io_bridges/devices/dronecan_node.hpp"
#include "io_bridges/devices/hmc5883l.hpp"

namespace whirl::io {

class FieldNode {
 public:
  using Triple = std::array<double, 3>;
  struct Setup {
    DroneCanNode::Setup node;
    Hmc5883l::Params part;
    std::function<Triple(const Triple&)> to_body;
  };
  FieldNode(EventQueue& queue, CanBus& bus, const Setup& setup, Hmc5883l::Sense sense,
            FaultBook* faults, FindingSink findings);

 private:
  void set_up();
  void read_data();

  EventQueue& queue_;
  Setup setup_;
  DroneCanNode node_;
  Wire drdy_{"drdy"};
  Hmc5883l part_;
  bool heard_ = false;  // since the last look
  Event read_over_, look_;
};

}  // namespace whirl::io
