// Whole pulses from the edges that a timer has captured between two looks.
//
//   Timer   a rising edge keeps the period that it ends and begins to count anew, a falling one keeps the width
//   Looks   once a millisecond. In that time a pulse of 900 us may have begun and ended: the width that is kept is
//           its own then, and not that of the pulse whose period has been kept. So a width is taken as it comes
//   Lost    of a millisecond with two rises, or with two falls around a rise, nothing is told but that it was so
//   After   five edges in a millisecond it may take the line for the other level, until the next one
#pragma once
#include <cstdint>

namespace fw::esc {

struct Pulse {
  std::uint32_t width_us = 0,
                period_us = 0;  // the period from the rise before it, or 0: no whole pulse
};

struct Captured {  // since the last look; of each kind none, one, or two and more
  unsigned rises = 0, falls = 0;
  std::uint32_t period_us = 0;  // if it rose
  std::uint32_t width_us = 0;   // if it fell
};

class PulseEdges {
 public:
  // True: a rise has ended `pulse`.
  bool look(const Captured& seen, Pulse& pulse) {
    const bool fell_before = seen.falls > 0 && (high_ || seen.rises == 0);  // it rose
    const bool whole = seen.rises < 2 && !(high_ && seen.falls > 1);
    pulse.width_us = fell_before ? seen.width_us : width_us_;
    pulse.period_us = whole ? seen.period_us : 0u;
    if (seen.falls > 0) width_us_ = seen.width_us;
    // Edges alternate, so the numbers tell where the line ends.
    high_ = high_ ? seen.falls <= seen.rises : seen.rises > seen.falls;
    return seen.rises > 0;
  }

 private:
  std::uint32_t width_us_ = 0;  // of the last pulse that has fallen
  bool high_ = false;           // at the last look
};

}  // namespace fw::esc
