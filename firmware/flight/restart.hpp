// Whether rotors that were all stopped in the air may be started again there: by force, a second word of the
// ground station that nobody gives by mistake.
//
//   Refused   attitude lost on the way (samples missing or frozen); the fall's speed not known; one to three
//             rotors failed, for what is left cannot fly; an ESC not ready; too low to turn upright and brake
//             above the ground
//   Blind     to where it is: one that was stopped less than a second ago above its take-off's ground, and
//             already lies on a roof or in a hand, is started too
//   Height    v t + g t^2 / 2 until the rotors carry upright, then (v + g t)^2 / 2 a, then what is left over.
//             Falls with stopped rotors ended at 22 m/s, which the air allows. From its side or its back it is turned
//             at 3 rad/s (they are asked for 3.6) to 28 degrees, and until then the rotors brake nothing. An ESC takes 0.32 s from a standing rotor to 90 % of 2 N, 0.52 s from one that windmills backward,
//             its status 0.05 s; four rotors of 6 N brake
//             900 g by 16.9 m/s^2, of which tilting and the air's own leave 12
#pragma once
#include <cmath>

#include "firmware/config/vehicle.hpp"
#include "firmware/flight/flight_state.hpp"

namespace fw {

inline constexpr unsigned kRotors = 4;

struct Fall {
  bool attitude_known = false, speed_known = false;
  float height_m = 0.0f, sinking_mps = 0.0f, tilt_rad = 0.0f;
  unsigned rotors_failed = 0;
  Reason esc_problem = Reason::none;
};

// The lowest height over ground at which a fall of this speed and tilt can be ended.
inline float restart_height_m(float sinking_mps, float tilt_rad) {
  constexpr float kStart_s = 0.6f, kBraking_mps2 = 12.0f, kLeft_m = 3.0f, kFastest_mps = 22.0f;
  constexpr float kLevel_rad = 0.49f, kRighting_radps = 3.0f;
  const float turn_rad = tilt_rad > kLevel_rad ? tilt_rad - kLevel_rad : 0.0f;
  const float falls_s = kStart_s + turn_rad / kRighting_radps;
  const float v0 = sinking_mps > 0.0f ? sinking_mps : 0.0f;
  const float freely_mps = v0 + config::kGravity_mps2 * falls_s;
  const float v1 = freely_mps > kFastest_mps && v0 < kFastest_mps ? kFastest_mps : freely_mps;
  return 0.5f * (v0 + v1) * falls_s + v1 * v1 / (2.0f * kBraking_mps2) + kLeft_m;
}

inline Reason why_not_restart(const Fall& fall) {
  if (fall.rotors_failed > 0 && fall.rotors_failed < kRotors) return Reason::motor_out;
  if (!fall.attitude_known) return Reason::attitude_lost;
  if (!fall.speed_known) return Reason::no_position;
  if (fall.esc_problem != Reason::none) return fall.esc_problem;
  if (!(fall.height_m > restart_height_m(fall.sinking_mps, fall.tilt_rad))) return Reason::too_low;
  return Reason::none;
}

}  // namespace fw
