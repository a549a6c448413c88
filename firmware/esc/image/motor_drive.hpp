// Between the control core and the bridge: start-up by alignment, commutation, what the samples say.
//
//   Threads  on_sample and on_commutation from their interrupts (commutation preempts sampling);
//            sense and follow from the control tick, under a lock where they share
#pragma once
#include <cstdint>

#include "firmware/esc/core/commutation.hpp"
#include "firmware/esc/core/core.hpp"
#include "firmware/esc/image/sampling.hpp"

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

class MotorDrive {
 public:
  void on_sample(const sampling::Sample& sample);
  void on_commutation();
  void follow(const Drive& wanted);
  Sensed sense();
  bool energised() const { return phase_ != Phase::off; }
  bool tripped();  // the PWM-rate over-current trip has acted since the last call

 private:
  enum class Phase : std::uint8_t { off, aligning, turning };

  void go_off();

  Commutation commutation_{CommutationConfig{}};
  Phase phase_ = Phase::off;
  std::uint16_t align_ms_ = 0;
  std::uint32_t shunt_sum_ = 0, bus_sum_ = 0, samples_ = 0;
  int zero_counts_ = 0;  // of the shunt, while off: the trip counts from there
  std::uint8_t over_ = 0;
  bool tripped_ = false;
  float speed_radps_ = 0.0f;
};

}  // namespace fw::esc
