// What may happen in which state, and what is done about what goes wrong: two tables, and the clockwork
// that reads them.
//
//   kCommands  states in which a command is taken; elsewhere it is refused as wrong_state
//   kRules     condition, how long it must hold, and the reaction by who steers. Of several that hold
//              the gravest reaction counts, then the first row. A later state never reacts more mildly to
//              what took control away: cut stays cut
//   Columns    armed on the ground; in the air by place, trajectory or velocity (autonomous); in the air by
//              the pilot's hand in attitude, which needs no position; the commanded
//              landing; the landing that is a fail-safe already
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/flight/flight_state.hpp"

namespace fw {

// And by force: restart.hpp.
enum class Command : std::uint8_t { arm, disarm, take_off, land, calibrate };

constexpr std::uint8_t in(FlightState state) {
  return static_cast<std::uint8_t>(1u << static_cast<unsigned>(state));
}

struct CommandRule {
  Command command;
  std::uint8_t states;
};
inline constexpr CommandRule kCommands[] = {
    {Command::arm, in(FlightState::disarmed) | in(FlightState::armed)},
    {Command::disarm, in(FlightState::disarmed) | in(FlightState::armed)},
    {Command::take_off, in(FlightState::armed) | in(FlightState::flying)},
    {Command::land, in(FlightState::flying) | in(FlightState::landing)},
    {Command::calibrate, in(FlightState::disarmed)},
};

constexpr bool allowed(Command command, FlightState state) {
  for (const CommandRule& rule : kCommands) {
    if (rule.command == command) return (rule.states & in(state)) != 0;
  }
  return false;
}

enum class Condition : std::uint8_t {
  imu_not_running,
  imu_frozen,
  tipped_over,
  esc_over_current,
  motor_out,
  esc_silent,
  no_position,
  outside_fence,
  battery_empty,
  no_link,
  rc_lost,
  rc_nonsense,
  no_setpoints,
  battery_low,
  no_pressure,
  no_field,
  heading_by_gyro,
  off_course,
  by_drag,
  count
};
inline constexpr std::size_t kConditions = static_cast<std::size_t>(Condition::count);

class Conditions {
 public:
  void set(Condition condition, bool holds) {
    const std::uint32_t bit = 1u << static_cast<unsigned>(condition);
    bits_ = holds ? bits_ | bit : bits_ & ~bit;
  }
  bool has(Condition condition) const {
    return (bits_ >> static_cast<unsigned>(condition) & 1u) != 0;
  }

 private:
  std::uint32_t bits_ = 0;
};

enum class Reaction : std::uint8_t {  // each graver than the one before
  none,
  tell,      // STATUSTEXT, once
  land,      // as commanded
  failsafe,  // land in the state failsafe: where there is no position, by vertical speed alone
  stop,      // motors off on the ground
  cut,       // motors off wherever it is: nothing can be controlled
};

enum class Column : std::uint8_t { armed, autonomous, by_attitude, landing, failsafe, count };

struct Rule {
  Condition condition;
  Reason reason;
  std::uint16_t holds_ms;
  std::array<Reaction, static_cast<std::size_t>(Column::count)> reactions;
};

namespace reaction {
inline constexpr Reaction none = Reaction::none, tell = Reaction::tell, land = Reaction::land,
                          fail = Reaction::failsafe, stop = Reaction::stop, cut = Reaction::cut;
// The ESC gives up its motor after 0.5 s without a set-point.
inline constexpr Rule kRules[kConditions] = {
    //                                                       armed autonomous attitude landing failsafe
    {Condition::imu_not_running, Reason::imu_not_running, 0, {cut, cut, cut, cut, cut}},
    {Condition::imu_frozen, Reason::imu_frozen, 0, {cut, cut, cut, cut, cut}},
    {Condition::tipped_over, Reason::tipped_over, 100, {cut, cut, cut, cut, cut}},
    // Its ESC has let go of the motor by then, which alone would be told as a motor that has stopped.
    {Condition::esc_over_current, Reason::esc_over_current, 0, {stop, cut, cut, cut, cut}},
    {Condition::motor_out, Reason::motor_out, 0, {stop, cut, cut, cut, cut}},
    {Condition::esc_silent, Reason::esc_silent, 0, {stop, cut, cut, cut, cut}},
    {Condition::no_position, Reason::no_position, 0, {stop, fail, tell, fail, none}},
    {Condition::outside_fence, Reason::outside_fence, 50, {tell, fail, tell, none, none}},
    {Condition::battery_empty, Reason::battery_empty, 2000, {stop, fail, fail, none, none}},
    {Condition::no_link, Reason::no_link, 0, {stop, land, tell, none, none}},
    {Condition::rc_lost, Reason::rc_lost, 0, {stop, land, land, none, none}},
    {Condition::rc_nonsense, Reason::rc_nonsense, 0, {stop, land, land, none, none}},
    {Condition::no_setpoints, Reason::no_setpoints, 0, {none, land, none, none, none}},
    {Condition::battery_low, Reason::battery_low, 3000, {stop, land, tell, none, none}},
    {Condition::no_pressure, Reason::no_pressure, 0, {tell, tell, tell, tell, tell}},
    {Condition::no_field, Reason::no_field, 0, {tell, tell, tell, tell, tell}},
    // By GPS only, where nothing else tells the heading: zero points wander by 0.05 deg/s, or more in a part that warms up.
    {Condition::heading_by_gyro, Reason::heading_by_gyro, 20'000, {none, fail, none, none, none}},
    {Condition::off_course, Reason::off_course, 500, {none, fail, none, fail, tell}},
    {Condition::by_drag, Reason::by_drag, 0, {none, tell, none, none, none}},
};
}  // namespace reaction
using reaction::kRules;

struct Decision {
  Reaction reaction = Reaction::none;
  Reason reason = Reason::none;
};

class Supervisor {
 public:
  // Each `dt_ms`, armed or not; disarmed nothing is decided, but what holds is remembered.
  Decision step(const Conditions& now, FlightState state, std::uint32_t dt_ms,
                bool by_attitude = false);
  // A warning that nobody has told yet, or none; it is told then.
  Reason take_warning();

 private:
  std::array<std::uint32_t, kConditions> held_ms_{};
  std::uint32_t to_tell_ = 0, told_ = 0;
};

}  // namespace fw
