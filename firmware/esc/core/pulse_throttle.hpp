// Servo pulses as set-points: what a receiver's output must look like to be followed.
//
//   Valid    900 to 2100 us, once in 2.3 to 22 ms (50 to 400 Hz and their clocks' tolerance)
//   Jumps    more than 50 us from the last taken pulse wait for a second one that agrees: a pulse that
//            a glitch has cut is never followed alone
//   Glitch   two rises within 2.3 ms: neither that pulse nor the next, which is a piece of it, counts
//   Scale    under 1100 us: 0; 1100 to 1950 us: 1 to 2047
//   Pace     zeros arm by their number (supervisor.hpp), so no two come within 19 ms: a source of 50 Hz
//            by its own clock may seem faster by ours
//   Source   [Bangura 2017, ch. 5: 1100 to 1950 us]
#pragma once
#include <cstdint>

#include "firmware/esc/core/setpoint.hpp"

namespace fw::esc {

class PulseThrottle {
 public:
  static constexpr std::uint32_t kShortest_us = 900, kLongest_us = 2100;
  static constexpr std::uint32_t kLow_us = 1100, kHigh_us = 1950;
  static constexpr std::uint32_t kFastest_us = 2300, kSlowest_us = 22'000;
  static constexpr std::uint32_t kJump_us = 50;
  static constexpr std::uint32_t kZeros_apart_us = 19'000;

  static constexpr bool in_range(std::uint32_t width_us) {
    return width_us >= kShortest_us && width_us <= kLongest_us;
  }
  // Pre: in_range(width_us).
  static constexpr std::uint16_t setpoint_of(std::uint32_t width_us) {
    if (width_us < kLow_us) return 0;
    const std::uint32_t above = (width_us < kHigh_us ? width_us : kHigh_us) - kLow_us;
    constexpr std::uint32_t span = kHigh_us - kLow_us;
    return static_cast<std::uint16_t>(1 + (above * (kSetpointMax - 1) + span / 2) / span);
  }

  // A captured pulse. True: v is a set-point.
  bool read(std::uint32_t width_us, std::uint32_t period_us, std::uint16_t& v) {
    const bool piece = follows_glitch_;
    follows_glitch_ = period_us < kFastest_us;
    if (piece || !in_range(width_us) || period_us < kFastest_us || period_us > kSlowest_us) {
      ++rejected_;
      return false;
    }
    const bool agrees = near(width_us, taken_us_) || near(width_us, waiting_us_);
    waiting_us_ = width_us;
    since_zero_us_ = since_zero_us_ > kZeros_apart_us ? since_zero_us_ : since_zero_us_ + period_us;
    if (!agrees) return false;
    taken_us_ = width_us;
    v = setpoint_of(width_us);
    if (v != 0) return true;
    if (since_zero_us_ < kZeros_apart_us) return false;
    since_zero_us_ = 0;
    return true;
  }
  std::uint32_t rejected() const { return rejected_; }

 private:
  static constexpr bool near(std::uint32_t a_us, std::uint32_t b_us) {
    return (a_us > b_us ? a_us - b_us : b_us - a_us) <= kJump_us;
  }

  std::uint32_t taken_us_ = 0, waiting_us_ = 0;
  std::uint32_t since_zero_us_ = 0;
  std::uint32_t rejected_ = 0;
  bool follows_glitch_ = false;
};

// Who commands: one source at a time, so that two that disagree do not alternate.
//
//   Rule   I2C goes before CAN, and CAN before pulses: the higher may always take over while the motor
//          is not armed, the lower only once the other has been silent for 0.5 s, when the supervisor
//          has disarmed it, too. While armed, the source that armed it stays.
class ThrottleSources {
 public:
  enum class Source : std::uint8_t { none, i2c, can, pulses };  // by rank
  static constexpr std::uint16_t kSilence_ms = 500;

  // A valid set-point of `from` has come; false: it is not followed.
  bool admit(Source from, bool armed) {
    const bool takes_over = owner_ == Source::none || (from < owner_ && !armed);
    if (from != owner_ && !takes_over) return false;
    owner_ = from;
    silent_ms_ = 0;
    return true;
  }
  void tick() {
    if (owner_ != Source::none && ++silent_ms_ >= kSilence_ms) owner_ = Source::none;
  }
  Source owner() const { return owner_; }

 private:
  Source owner_ = Source::none;
  std::uint16_t silent_ms_ = 0;
};

}  // namespace fw::esc
