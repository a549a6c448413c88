// The servo output of a radio receiver: a pulse train on one wire, and what may disturb it.
//
//   Pulses   high for `width` once per `period`; a new train begins with the period that runs
//   Silence  width 0: the line stays low
//   Glitch   the line inverted for `glitch`, `glitch_after` behind each rising edge
#pragma once
#include <string>

#include "io_bridges/devices/event_queue.hpp"
#include "io_bridges/devices/wire.hpp"

namespace whirl::io {

class PulseSource {
 public:
  struct Train {
    Nanoseconds width_ns = 0;
    Nanoseconds period_ns = 20'000'000;  // longer than the width
    Nanoseconds glitch_ns = 0, glitch_after_ns = 0;
  };

  PulseSource(EventQueue& queue, Wire& wire, const std::string& name = "pulse source");

  void set(const Train& train);

 private:
  void begin();
  void drive(bool high);
  void invert();

  EventQueue& queue_;
  Wire& wire_;
  int driver_;
  Train train_;
  bool high_ = false;      // the pulse
  bool inverted_ = false;  // the glitch
  Event period_, fall_, glitch_, glitch_end_;
};

}  // namespace whirl::io
