// The zero crossings of a turning motor's back-EMF, as a free-running timer would stamp them.
//
//   In      the shaft's speed at the ends of a step; within it the speed is taken as their mean
//   Out     six crossings per electrical revolution in ticks of 0.5 us, and what the firmware reads
//           out of their distances (Pace)
//   Sync    follows the rotor once it has six sectors in a row; lost when nothing crosses for nine
//   Left out noise of the comparison: the image on its stand tells a steady speed within 1 RPM
#pragma once
#include <array>
#include <cstdint>

#include "firmware/esc/core/commutation.hpp"

namespace whirl::flight {

class ZeroCrossings {
 public:
  explicit ZeroCrossings(int pole_pairs);

  void restart();  // nobody has looked so far
  // Pre: to_ns > from_ns; steps follow each other.
  void turn(std::int64_t from_ns, std::int64_t to_ns, double from_radps, double to_radps);

  bool in_sync() const { return seen_ > 6; }
  double silent_s() const { return 1e-9 * static_cast<double>(now_ns_ - since_ns_); }
  fw::esc::Pace pace() const;
  float radps(std::uint32_t ticks, unsigned sectors) const;  // of the shaft

 private:
  void record(std::int64_t at_ns);
  std::int64_t ticks_since_crossing() const;

  fw::esc::CommutationConfig config_;
  double sectors_ = 0.0;  // turned since the last crossing, 0..1
  std::array<fw::esc::Ticks, 6> lengths_{};
  std::uint8_t next_ = 0;  // of lengths_, to be written
  int seen_ = 0;           // crossings, up to seven
  std::int64_t crossed_tick_ = 0;
  std::int64_t since_ns_ = 0, now_ns_ = 0;  // last crossing, or when looking began
};

}  // namespace whirl::flight
