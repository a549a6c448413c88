// A radio-control receiver with SBUS output on a UART.
//
//   Line     100000 baud 8E2, inverted on copper. A board may have an inverter before its UART; without
//            one, and with a UART that cannot invert, the MCU reads garbage
//   Frame    25 bytes behind one another, 3 ms, each period. Nothing before 200 ms after power-up
//   Flags    frame lost: no news from the transmitter for lost_after; failsafe: for failsafe_after, or
//            never yet; then both
//   Failsafe stop: nothing is sent; hold: the last positions; fixed: thrust below its stop, the others
//            centred; before it hears anything hold centres all (thrust at its lower stop)
//   Fault    rc_link_lost (radio_link.hpp); rc_glitch: all channels of the frame are any, its parity is
//            right
//   Source   bolderflight/sbus, PX4 sbus.c, Betaflight rx/sbus.c
//   Memory   period of 14 ms; 200 ms; how long frames are lost before failsafe
//   Left out digital channels 17 and 18 (0); what the MCU sends: the line is one way
#pragma once
#include <optional>
#include <string>

#include "base/random.hpp"
#include "io_bridges/devices/radio_link.hpp"
#include "io_bridges/devices/uart_transmitter.hpp"
#include "io_bridges/protocols/sbus.hpp"

namespace whirl::io {

// What the receiver puts out: nothing, or a frame with its flags.
std::optional<SbusFrame> sbus_frame(RadioLink::Output out, Failsafe failsafe);

// The fault rc_glitch, of the frames of one receiver.
class SbusGlitches {
 public:
  SbusGlitches(FaultBook* faults, int bus, int device, std::uint64_t seed, const std::string& name)
      : faults_(faults), bus_(bus), device_(device), nonsense_(seed, name + ".nonsense") {}
  void spoil(SbusFrame& frame, Nanoseconds now);

 private:
  FaultBook* faults_;
  int bus_, device_;
  RandomStream nonsense_;
};

class SbusReceiver : public UartPeer {
 public:
  struct Params {
    std::string name = "receiver";
    Nanoseconds period_ns = core::receiver::kSbusPeriod_ns;
    bool inverter = false;  // on the board
    RadioLink::Params link = {};
    std::uint64_t seed = 1;
  };

  SbusReceiver(EventQueue& queue, const Params& params, FaultBook* faults);

  void on_sticks(const StickPositions& sticks) { link_.on_sticks(sticks, queue_.now()); }
  void receive(const UartByte&, const UartFormat&, Nanoseconds) override {}

 private:
  void begin_frame();

  EventQueue& queue_;
  Params params_;
  RadioLink link_;
  UartTransmitter transmitter_;
  SbusGlitches glitches_;
  Event frame_;
};

}  // namespace whirl::io
