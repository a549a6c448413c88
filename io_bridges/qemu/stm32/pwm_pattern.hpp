// What a timer puts out, for a power stage that wants averages and edges without an event per edge.
//
//   A pattern holds from t_ns until the next one. Told only when something changes: at the update
//   event that loads new shadows, or at the write that acts at once (mode, enable, MOE, CEN).
//   Phase   centre-aligned: OCxREF of PWM mode 1 is on while |phase| < on_steps around
//           period_start; up-counting: on in [0, on_steps); down-counting: the last on_steps
#pragma once
#include <array>
#include <cstdint>

#include "io_bridges/devices/event_queue.hpp"

namespace whirl::stm32 {

struct PwmChannel {
  bool driven = false;         // OCx drives its pin
  bool driven_n = false;       // OCxN drives its pin
  bool active_low = false;     // CCxP
  bool active_low_n = false;   // CCxNP
  bool complementary = false;  // OCxN is the inverse of OCxREF (both enabled), with dead time
  bool inverted = false;       // PWM mode 2: OCxREF is off where mode 1 is on
  bool modulated = false;      // OCxREF changes within the period
  double duty = 0.0;           // share of the period in which OCxREF is active, 0..1

  bool operator==(const PwmChannel&) const = default;
};

struct PwmPattern {
  bool counting = false;
  bool centre_aligned = false;
  bool down = false;
  double period_s = 0.0;
  double dead_time_s = 0.0;
  std::array<PwmChannel, 4> channel;
  std::int64_t period_start_ns = 0;  // some start of a period: the counter was at its first step
  std::int64_t t_ns = 0;             // since when this holds
};

}  // namespace whirl::stm32
