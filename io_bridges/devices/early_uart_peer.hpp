// The far end of a UART that is told of each character at its start bit, too: a wire to another board has to know of it
// before it has passed.
#pragma once
#include "io_bridges/devices/bus.hpp"

namespace whirl::io {

class EarlyUartPeer : public UartPeer {
 public:
  // What is on its way, and when its last stop bit will have passed: receive() follows then, but for a reset of the MCU.
  virtual void begin(const UartByte& byte, const UartFormat& format, Nanoseconds now,
                     Nanoseconds end) = 0;
};

}  // namespace whirl::io
