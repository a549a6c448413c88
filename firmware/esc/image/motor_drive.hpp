// Between the control core and the bridge: start-up by alignment, commutation, what the samples say.
//
//   Threads  on_sample and on_commutation from their interrupts (commutation preempts sampling);
//            sense and follow from the control tick, under a lock where they share
#pragma once
#include <cstdint>

#include "firmware/esc/core/commutation.hpp"
#include "firmware/esc/core/core.hpp"
#include "firmware/esc/core/sensing.hpp"
#include "firmware/esc/image/sampling.hpp"

namespace fw::esc {

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
  SmoothSpeed speed_;
};

}  // namespace fw::esc
