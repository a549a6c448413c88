// Two clocks, aligned by marker pulses: the analyser's time of a pulse against the host's, which is known to lie
// between the moment before the pulse was asked for and the moment after.
//
//   Fit      offset and rate through the first and the last pulse, each taken in the middle of its interval
//   Residue  the largest time by which a fitted time may be wrong: half of the wider interval, and what the pulses
//            between the two are off the line; of one pulse alone the rate is not known: kRate_error of the distance is
//            added
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

namespace whirl::copper {

struct MarkerPulse {
  std::int64_t before_host_ns = 0, after_host_ns = 0;
  std::int64_t analyser_ns = 0;
};

struct ClockFit {
  std::int64_t analyser_zero_ns = 0, host_zero_ns = 0;  // the first pulse on both
  double rate = 1.0;                                    // host's time to the analyser's
  double residue_ns = 0.0;                              // within the pulses
  bool rate_known = false;

  std::int64_t host_ns(std::int64_t analyser_ns) const;
  // At that time, outside of the pulses and with one of them too.
  double residue_at_ns(std::int64_t analyser_ns) const;
};

inline constexpr double kRate_error = 100e-6;  // of two crystals

// In order of time. Nothing without a pulse, or of pulses whose analyser times do not grow.
std::optional<ClockFit> fit_clocks(const std::vector<MarkerPulse>& pulses);

}  // namespace whirl::copper
