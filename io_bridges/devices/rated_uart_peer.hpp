// The far end of a UART that sets itself to another rate when it is told to: who plays it on a line has to follow.
#pragma once
#include "io_bridges/devices/bus.hpp"

namespace whirl::io {

class RatedUartPeer : public UartPeer {
 public:
  virtual double baud() const = 0;  // of what it sends and understands next
};

}  // namespace whirl::io
