// A radio-control receiver with a sum signal (CPPM): all channels one after another on one wire.
//
//   Signal   n + 1 pulses a frame; from edge to edge of the same kind 1500 us + 500 us x position (900 to
//            2100 us), in steps of 0.5 us; then the gap to the frame's end, 4 ms at least: a frame that
//            is too short for its channels becomes longer
//   Polarity positive: idle low, pulses high; negative: the other way round
//   Jitter   of each edge about its place, normal, 2 us RMS, 10 us at most; it does not add up
//   Failsafe stop: the line idles; hold: the last positions; fixed: the same with thrust below its stop.
//            Before it hears anything, hold is silent, too. The signal carries no flag
//   Fault    rc_link_lost (radio_link.hpp); rc_glitch: of a frame, one channel has any length of 0.3 to
//            3 ms
//   Source   measured and stated frames of receivers (mftech.de ppm_en, an MC-12 by oscilloscope),
//            decoders of PX4 (drv_hrt.c) and Betaflight (rx_pwm.c)
//   Memory   jitter, step
#pragma once
#include <string>
#include <vector>

#include "base/random.hpp"
#include "io_bridges/devices/radio_link.hpp"
#include "io_bridges/devices/wire.hpp"

namespace whirl::io {

class CppmReceiver {
 public:
  struct Params {
    std::string name = "receiver";
    int channels = 8;  // 4..16
    Nanoseconds frame_ns = core::receiver::kCppmFrame_ns, pulse_ns = core::receiver::kCppmPulse_ns;
    bool negative = false;
    double jitter_s = 2e-6;    // RMS
    double clock_error = 0.0;  // share by which its clock is slow: all times are longer
    RadioLink::Params link = {};
    std::uint64_t seed = 1;
  };

  CppmReceiver(EventQueue& queue, Wire& wire, const Params& params, FaultBook* faults);

  void on_sticks(const StickPositions& sticks) { link_.on_sticks(sticks, queue_.now()); }

 private:
  void begin_frame();
  void pulse();
  void drive(bool pulse);
  Nanoseconds jitter();
  Nanoseconds by_its_clock(double ns) const;

  EventQueue& queue_;
  Wire& wire_;
  Params params_;
  FaultBook* faults_;
  RadioLink link_;
  RandomStream jitter_, nonsense_;
  int driver_;
  std::vector<Nanoseconds> pulses_;  // of this frame, when each begins
  std::size_t next_ = 0;
  Event frame_, pulse_, pulse_end_;
};

}  // namespace whirl::io
