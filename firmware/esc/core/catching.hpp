// Finds a rotor that turns while all switches are off, so that commutation can join it without a jerk;
// or finds that it stands, or turns backward.
//
//   Law      with the bridge off the terminals show the back-EMF above the lowest diode. The highest of
//            the three changes every two sectors, at the moments when steps 2, 4, 0 begin; two changes
//            in a forward sense tell where the rotor is and how fast. (The lowest is clipped at the
//            converter's zero: it does not count.) Three changes in the other sense are a rotor that the air
//            turns backward: no sense to join, but the alignment's field brakes it
//   Time     one sample per PWM period, in the ticks of commutation.hpp
#pragma once
#include <cstdint>

#include "firmware/esc/core/commutation.hpp"

namespace fw::esc {

class Catching {
 public:
  enum class Found : std::uint8_t { nothing_yet, standing, turning, backward };

  void start(Ticks now) {
    highest_ = kUnknown;
    changed_at_ = now;
    sector_ = 0;
    backward_ = 0;
    settling_ = kSettling;
  }

  // Phases in counts. turning: join at step() with sector(), now.
  Found on_sample(Ticks now, int a, int b, int c) {
    if (settling_ > 0) {  // the last currents still flow through diodes
      --settling_;
      changed_at_ = now;
      return Found::nothing_yet;
    }
    const int phase[3] = {a, b, c};
    std::uint8_t top = a >= b ? 0 : 1;
    if (c > phase[top]) top = 2;
    const auto since = static_cast<Ticks>(now - changed_at_);
    if (highest_ != kUnknown && phase[top] - phase[highest_] < kClear_counts) {
      return since > kStanding ? Found::standing : Found::nothing_yet;
    }
    const bool forward = highest_ != kUnknown && top == (highest_ + 1) % 3;
    const bool measured = forward && followed_;
    backward_ = highest_ == kUnknown || forward ? std::uint8_t{0}
                                                : static_cast<std::uint8_t>(backward_ + 1);
    followed_ = forward;
    highest_ = top;
    changed_at_ = now;
    if (backward_ == kBackward) return Found::backward;
    if (!measured) return Found::nothing_yet;
    sector_ = static_cast<Ticks>(since / 2);
    return Found::turning;
  }

  bool backward() const { return backward_ == kBackward; }
  std::uint8_t step() const { return static_cast<std::uint8_t>(2 * highest_); }
  Ticks sector() const { return sector_; }

 private:
  static constexpr std::uint8_t kUnknown = 3;
  static constexpr std::uint8_t kSettling = 6;  // samples
  static constexpr std::uint8_t kBackward = 3;  // changes in a row: a revolution (electrical)
  // 0.15 V: offsets of two channels (5 counts) and their noise (1.5 to 2 rms each, 300 looks) do not reach
  // it; a rotor of 0.01 V s does from 30 rad/s on, and is aligned below.
  static constexpr int kClear_counts = 24;
  static constexpr Ticks kStanding = 30'000;  // 15 ms: under 20 rad/s with 7 pole pairs

  std::uint8_t highest_ = kUnknown, settling_ = 0, backward_ = 0;
  bool followed_ = false;  // the last change was forward: the next one has a length
  Ticks changed_at_ = 0, sector_ = 0;
};

}  // namespace fw::esc
