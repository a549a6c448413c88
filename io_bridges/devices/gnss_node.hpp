// A DroneCAN node with a u-blox M8: its program sets the receiver up by UBX and sends each solution on CAN.
//
//   Part     message by message, on a UART of the node's own at 115200 baud, with its faults (ublox.hpp)
//   Settings 200 ms per solution, airborne model, NAV-PVT alone
//   Sends    gnss.Fix2 as the last byte of NAV-PVT has come; `status` is 3D only within the receiver's limits.
//            Covariance: variances north, east, down of place, then of velocity. The node's clock is told to
//            nobody: timestamp 0
//   Silence  2 s without a solution: the receiver is set up anew
#pragma once
#include "io_bridges/devices/dronecan_node.hpp"
#include "io_bridges/devices/ublox.hpp"

namespace whirl::io {

class GnssNode {
 public:
  static constexpr std::uint32_t kBaud = 115'200;

  GnssNode(EventQueue& queue, CanBus& bus, const DroneCanNode::Setup& node,
           const Ublox::Params& part, Ublox::Sense sense, FaultBook* faults, FindingSink findings);

 private:
  void set_up();
  void tell(const UbxFrame& frame);
  void on_frame(const UbxFrame& frame);

  EventQueue& queue_;
  DroneCanNode node_;
  Ublox part_;
  UbxParser parser_;
  bool heard_ = false;  // since the last look
  Event look_;
};

}  // namespace whirl::io
