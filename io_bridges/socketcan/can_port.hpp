// A node's place on a CAN bus of this host: frames out and in, and what the controller says of the bus.
//
//   Turn     nothing here waits; `file` can be polled for reading
//   Times    of the host's monotonic clock: when the frame had been received, as the controller or the kernel
//            stamped it. Hardware stamps are of a clock of their own: see stamp_clock.hpp
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "base/result.hpp"
#include "io_bridges/protocols/can_frame.hpp"

namespace whirl::io {

enum class CanBusState : std::uint8_t {
  active,   // error active
  warning,  // a counter is at 96 or above
  passive,  // at 128 or above: it cannot signal errors any more
  bus_off,  // takes no part
  stopped,  // is down, or sleeps
  unknown,  // virtual ones have no state
};
const char* name(CanBusState state);

// What a controller told of the bus by an error frame (Linux, include/uapi/linux/can/error.h).
struct CanTrouble {
  bool bus_off = false, restarted = false;
  bool no_acknowledge = false;  // nobody else is on the bus, or not at this bit rate
  bool lost_arbitration = false;
  bool protocol = false;  // a bit, stuff, form or CRC error
  bool bus_error = false;
  bool receive_overflow = false, transmit_overflow = false;  // of the controller
  bool transmit_time_out = false;
  bool transceiver = false;
  std::optional<CanBusState> state = {};
  std::optional<std::uint8_t> transmit_errors = {},
                              receive_errors = {};  // the controller's counters
};

struct CanArrival {
  std::int64_t host_ns = 0;
  bool hardware_stamp = false;
  bool own = false;  // what this port has sent, once it has passed the bus
  CanFrame frame = {};
  std::optional<CanTrouble> trouble = {};  // an error frame: `frame` is nothing
  std::uint32_t dropped = 0;               // by the kernel before this one: our side was too slow
};

class CanPort {
 public:
  virtual ~CanPort() = default;
  // False: its queue is full now; nothing was sent. Errors  host: it went down, or was unplugged
  virtual Result<bool> send(const CanFrame& frame) = 0;
  // Nothing: none has come. Errors  host: as send()
  virtual Result<std::optional<CanArrival>> receive() = 0;
  virtual int file() const = 0;
  virtual std::string version()
      const = 0;  // "can0: gs_usb, 1000000 bit/s, restarts itself after 100 ms"
};

}  // namespace whirl::io
