// What the rotor takes in still air, here and today: told by who knows that the air is still.
//
//   Why     Power tells inflow as a share of still air's power. That share is wrong by all that has changed since the
//           calibration: density, winding, bearing, another motor or propeller of the same make. One second in
//           still air tells it all, as one number
//   Use     begin() while the rotor turns in still air; sample() each millisecond until it no longer says `measuring`;
//           then Core::take_still_power(share()). `found` and a wind is a lie: nobody here can tell
//   Share   of the map's power at this speed, mean of 1 s in which the rotor is calm and its current has no gaps
//   Refused no such second within 5 s (no calibration, standing, outside its speeds, restless), or a share
//           that no air of a place where people live and no copy of the parts has: beyond 15 %
#pragma once
#include <cstdint>

#include "firmware/esc/core/core.hpp"

namespace fw::esc {

class StillAir {
 public:
  enum class Answer : std::uint8_t { measuring, found, refused };

  static constexpr std::uint16_t kMean_ms = 1000, kLongest_ms = 5000;
  static constexpr float kMost_off = 0.15f;

  void begin() {
    all_ms_ = 0;
    begin_again();
  }

  Answer sample(const Core& core) {
    if (++all_ms_ > kLongest_ms) return Answer::refused;
    const ThrustEstimator& estimator = core.estimator();
    // Of a bridge that is off, the balance is what it was last.
    if (!core.drive().energised || !estimator.balanced()) {
      begin_again();
      return Answer::measuring;
    }
    sum_ += estimator.balance_ratio();
    if (++calm_ms_ < kMean_ms) return Answer::measuring;
    const float off = share() - 1.0f;
    return off * off <= kMost_off * kMost_off ? Answer::found : Answer::refused;
  }
  // Of what was `found`.
  float share() const { return sum_ / static_cast<float>(kMean_ms); }

 private:
  void begin_again() { sum_ = 0.0f, calm_ms_ = 0; }

  float sum_ = 0.0f;
  std::uint16_t calm_ms_ = 0, all_ms_ = 0;
};

}  // namespace fw::esc
