// The stream's rate and its way out: the control tick notes a sample when one is due, the main loop
// packs it and queues it on the serial line.
//
//   Lost    a sample that found no room, or the last one not yet packed, leaves a gap in the sequence
#pragma once
#include <cstdint>

#include "firmware/esc/image/stream_frame.hpp"

namespace fw::esc::stream {

// Samples per second, rounded to whole ticks; 0 stops. False: out of 0..1000.
bool set_rate(float rate_Hz);
bool due();                               // once per tick
void record(const StreamSample& sample);  // from the tick
void send();                              // from the main loop

}  // namespace fw::esc::stream
