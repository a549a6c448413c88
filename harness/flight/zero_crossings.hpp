// The zero crossings of a turning motor's back-EMF, as a free-running timer would stamp them, and the
// speed that follows from the last electrical revolution.
//
//   In      the shaft's speed at the ends of a step; within it the speed is taken as their mean
//   Out     six crossings per electrical revolution, stamped in ticks of 0.5 us
//   Law     w = 2 pi / (pole pairs x time of the last six sectors)    [Bangura2017, 3.3.1.1]
//   Sync    follows the rotor once it has six sectors in a row; lost when nothing crosses for nine
//   Left out noise of the comparison: the image on its stand tells a steady speed within 1 RPM
#pragma once
#include <array>
#include <cstdint>

namespace whirl::flight {

class ZeroCrossings {
 public:
  explicit ZeroCrossings(int pole_pairs) : pole_pairs_(pole_pairs) {}

  void restart() { seen_ = 0; }  // nobody has looked so far
  // Pre: to_ns > from_ns; steps follow each other.
  void turn(std::int64_t from_ns, std::int64_t to_ns, double from_radps, double to_radps);

  bool in_sync() const { return seen_ > kSectors; }
  double speed_radps() const;  // 0 when not in sync

 private:
  static constexpr int kSectors = 6;

  void note(std::int64_t tick);
  std::int64_t newest() const { return ticks_[static_cast<std::size_t>(newest_)]; }
  std::int64_t oldest() const { return ticks_[static_cast<std::size_t>((newest_ + 1) % 7)]; }

  int pole_pairs_;
  double sectors_ = 0.0;  // turned since the last crossing, 0..1
  std::array<std::int64_t, kSectors + 1> ticks_{};
  int newest_ = 0, seen_ = 0;
};

}  // namespace whirl::flight
