// What stands between a measurement and the control core, wherever the core runs.
#pragma once
#include <cstdint>

namespace fw::esc {

// The amplifier's offset wanders by amperes: averaged whenever the motor stands without current.
class ZeroCurrent {
 public:
  void note(float current_A) {
    // 0.1 s at first, then 2 s: a quick start and a quiet value.
    const float blend = settled_ms_ < 500 ? 0.01f : 0.0005f;
    if (settled_ms_ < 500) ++settled_ms_;
    offset_A_ += blend * (current_A - offset_A_);
  }
  float offset_A() const { return offset_A_; }

 private:
  float offset_A_ = 0.0f;
  std::uint16_t settled_ms_ = 0;
};

// Speed from zero crossings, once per millisecond: half the last one, half the new one
// [Bangura 2017, sec. 3.3.1.1]; nothing while commutation does not follow the rotor.
class SmoothSpeed {
 public:
  float update(float speed_radps, bool in_sync) {
    speed_radps_ = in_sync ? 0.5f * (speed_radps_ + speed_radps) : 0.0f;
    return speed_radps_;
  }

 private:
  float speed_radps_ = 0.0f;
};

}  // namespace fw::esc
