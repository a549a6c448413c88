// Whether rotors that were all stopped in the air may be started again there: by force, a second word of the
// ground station that nobody gives by mistake.
//
//   Refused   attitude lost on the way (samples missing or frozen); the fall's speed not known; one to three
//             rotors failed, for what is left cannot fly; an ESC not ready; too low to turn upright and brake
//             above the ground
//   Blind     to where it is: one that was stopped less than a second ago above its take-off's ground, and
//             already lies on a roof or in a hand, is started too
//   Height    (v0 + v1) t / 2 until the rotors carry upright, then v1^2 / 2 a, then what is left over. Until then it
//             gains v1 - v0 = (g - k v0^2) t: what the air holds against it is what the accelerometer has felt on
//             this very fall (FallDrag), nothing before that is known. From its side or its back it is turned
//             at 3 rad/s (they are asked for 3.6) to 28 degrees, and until then the rotors brake nothing. An ESC takes 0.32 s from a
//             standing rotor to 90 % of 2 N, 0.52 s from one that windmills backward, its status 0.05 s. Then four
//             rotors brake by what they have beside the weight, of which tilting takes three tenths
#pragma once
#include <algorithm>
#include <cmath>
#include <optional>

#include "firmware/config/vehicle.hpp"
#include "firmware/flight/flight_state.hpp"

namespace fw {

inline constexpr unsigned kRotors = 4;

// What the air holds against a fall, per mass and by the square of its speed: the least that was felt since the
// rotors were stopped. A body that turns shows the air its edge as well as its face, and what is not known counts as
// nothing, so that a fall is rather taken to become faster than it does.
class FallDrag {
 public:
  void start() { felt_mps2_ = 0.0f, least_pm_.reset(); }
  // Specific force upward, and downward speed.
  void step(float upward_mps2, float sinking_mps, float dt_s) {
    constexpr float kMean_s = 0.1f,
                    kTold_mps = 10.0f;  // slower, an accelerometer's zero tells more
    felt_mps2_ += dt_s / kMean_s * (upward_mps2 - felt_mps2_);
    if (!(sinking_mps > kTold_mps)) return;
    const float drag_pm = std::max(0.0f, felt_mps2_ / (sinking_mps * sinking_mps));
    least_pm_ = std::min(drag_pm, least_pm_.value_or(drag_pm));
  }
  float least_pm() const { return least_pm_.value_or(0.0f); }

 private:
  float felt_mps2_ = 0.0f;
  std::optional<float> least_pm_;
};

struct Fall {
  bool attitude_known = false, speed_known = false;
  float height_m = 0.0f, sinking_mps = 0.0f, tilt_rad = 0.0f, drag_pm = 0.0f;
  unsigned rotors_failed = 0;
  Reason esc_problem = Reason::none;
};

// The lowest height over ground at which a fall of this speed and tilt can be ended.
inline float restart_height_m(float sinking_mps, float tilt_rad, float drag_pm) {
  constexpr float kStart_s = 0.6f, kLeft_m = 3.0f;
  constexpr float kBraking_mps2 =
      0.7f * (kRotors * config::kThrustUsable_N / config::kMass_kg - config::kGravity_mps2);
  constexpr float kLevel_rad = 0.49f, kRighting_radps = 3.0f;
  const float turn_rad = tilt_rad > kLevel_rad ? tilt_rad - kLevel_rad : 0.0f;
  const float falls_s = kStart_s + turn_rad / kRighting_radps;
  const float v0 = sinking_mps > 0.0f ? sinking_mps : 0.0f;
  const float v1 = v0 + std::max(0.0f, config::kGravity_mps2 - drag_pm * v0 * v0) * falls_s;
  return 0.5f * (v0 + v1) * falls_s + v1 * v1 / (2.0f * kBraking_mps2) + kLeft_m;
}

inline Reason why_not_restart(const Fall& fall) {
  if (fall.rotors_failed > 0 && fall.rotors_failed < kRotors) return Reason::motor_out;
  if (!fall.attitude_known) return Reason::attitude_lost;
  if (!fall.speed_known) return Reason::no_position;
  if (fall.esc_problem != Reason::none) return fall.esc_problem;
  const float least_m = restart_height_m(fall.sinking_mps, fall.tilt_rad, fall.drag_pm);
  if (!(fall.height_m > least_m)) return Reason::too_low;
  return Reason::none;
}

}  // namespace fw
