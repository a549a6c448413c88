// What stands between a measurement and the control core, wherever the core runs.
#pragma once
#include <cstdint>

namespace fw::esc {

// The ESC32v2's converter, 12 bits of 3.3 V: voltages behind 1.5/11.5 dividers, a shunt of 0.5 mohm
// with a gain of 50.9.
inline constexpr float kVolts_per_count = 3.3f / 4096.0f * 11.5f / 1.5f;
inline constexpr float kAmperes_per_count = 3.3f / 4096.0f / (0.5e-3f * 50.9f);

// The amplifier's offset wanders by amperes: averaged whenever the motor stands without current, from
// anew at every rest.
class ZeroCurrent {
 public:
  void record(float current_A) {
    if (rest_ms_ < kLongest_ms) ++rest_ms_;
    if (known_before_ && rest_ms_ <= kDecay_ms) return;
    // The mean of this rest so far; what was known before counts as much as a short rest.
    const std::uint16_t n = known_before_ ? rest_ms_ - kDecay_ms + kTrust_ms : rest_ms_;
    offset_A_ += (current_A - offset_A_) / static_cast<float>(n);
    known_ = true;
  }
  void turns() {  // the motor is driven: the rest is over
    rest_ms_ = 0;
    known_before_ = known_;
  }
  float offset_A() const { return offset_A_; }

 private:
  static constexpr std::uint16_t kDecay_ms = 20;     // until amplifier and windings are quiet
  static constexpr std::uint16_t kTrust_ms = 50;     // weight of the rests before
  static constexpr std::uint16_t kLongest_ms = 400;  // of the mean: a wandering offset is followed

  float offset_A_ = 0.0f;
  std::uint16_t rest_ms_ = 0;
  bool known_ = false, known_before_ = false;
};

// How far the offset may have gone since it was found, one sigma: it wanders by a little for ever, and
// by much more in the first 100 s after power-up.
class OffsetError {
 public:
  explicit OffsetError(float period_s) : share_(period_s / kTime_s) {}
  void tick(bool rests) {
    cold_ = cold_ > 1e-3f ? cold_ - share_ * cold_ : 0.0f;
    gone_ = rests ? 0.0f : gone_ + share_ * (1.0f - gone_);
  }
  // warm_up_A: of the drift after power-up, one sigma.
  float amperes(float warm_up_A) const { return kWander_A + warm_up_A * cold_ * gone_; }
  // What is still to come of the drift does not count beside the wander: of 0.4 A after 98 s.
  bool settled(float warm_up_A) const { return warm_up_A * cold_ < kSettled_A; }

 private:
  static constexpr float kWander_A = 0.008f;
  static constexpr float kSettled_A = 0.015f;
  static constexpr float kTime_s = 30.0f;  // of the drift
  float share_;
  float cold_ = 1.0f;  // of the drift, still to come
  float gone_ = 0.0f;  // of that, since the last rest
};

// The shunt's amplifier (1 kHz) makes pulses of the PWM (20 kHz) nearly their mean; sampled at their
// end it stands at (1 - e^-dx) / (d (1 - e^-x)) of it, x = 0.314: 13 % above at a duty of 0.2. Here to
// 0.2 % of the mean.
inline float without_ripple(float current_A, float duty) {
  const float off = 1.0f - duty;
  return current_A / (1.0f + off * (0.147f + 0.017f * off));
}

// Speed from zero crossings, once per millisecond: half the last one, half the new one
// [Bangura 2017, sec. 3.3.1.1]; nothing while commutation does not follow the rotor.
class SmoothSpeed {
 public:
  float update(float speed_radps, bool in_sync) {
    // Nothing to be mixed with the first one.
    const float last_radps = speed_radps_ > 0.0f ? speed_radps_ : speed_radps;
    speed_radps_ = in_sync ? 0.5f * (last_radps + speed_radps) : 0.0f;
    return speed_radps_;
  }

 private:
  float speed_radps_ = 0.0f;
};

}  // namespace fw::esc
