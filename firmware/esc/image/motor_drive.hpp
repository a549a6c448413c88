// Between the control core and the bridge: catches a rotor that turns, starts one that stands by
// alignment, commutates, keeps the winding current within its limits from one PWM period to the next.
//
//   Probing  between alignment and start, where the rotor stands for certain: every other PWM period one pulse
//            in each of the six steps, for the middles of their floating phases (middles.hpp)
//   Threads  on_sample and on_commutation from their interrupts (commutation preempts sampling);
//            sense and follow from the control tick, under a lock where they share
#pragma once
#include <cstdint>

#include "firmware/esc/core/catching.hpp"
#include "firmware/esc/core/commutation.hpp"
#include "firmware/esc/core/core.hpp"
#include "firmware/esc/core/sensing.hpp"
#include "firmware/esc/core/winding_guard.hpp"

namespace fw::esc {

class MotorDrive {
 public:
  void on_sample();
  void on_commutation();
  void follow(const Drive& wanted);
  void know(const Calibration& calibration);  // at rest
  Sensed sense();
  bool energised() const { return phase_ != Phase::off; }
  bool tripped();  // the PWM-rate over-current trip has acted since the last call

 private:
  enum class Phase : std::uint8_t { off, catching, aligning, probing, turning };

  void go_off();
  void go_catching();
  void go_probing();
  // Apart from what runs in every period, which is short of time.
  __attribute__((noinline)) void look_for_rotor();
  __attribute__((noinline)) void probe();
  void watch_current(int shunt_counts, int bus_counts);
  void commutate_by(int floating_counts, int bus_counts);
  void record(int shunt_counts, int bus_counts);

  Catching catching_;
  WindingGuard guard_;
  Phase phase_ = Phase::off;
  std::uint16_t align_ms_ = 0;
  std::uint16_t phase_ms_ = 0;     // aligning, or not in sync
  bool pulsed_ = false;            // probing: this period has a pulse
  std::uint32_t wanted_duty_ = 0;  // PWM counts, before the guard
  std::uint32_t shunt_sum_ = 0, bus_sum_ = 0, samples_ = 0;
  int zero_counts_ = 0;  // 64 times the shunt's, while off: the guard counts from there
  bool tripped_ = false;
  SmoothSpeed speed_;
  Commutation commutation_{CommutationConfig{}};  // last: the others have short addresses then
};

}  // namespace fw::esc
