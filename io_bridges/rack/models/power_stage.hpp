// The power stage of a motor controller: six switches between the chip's pins and a motor, and what
// the chip measures of it.
//
//   Wiring   ESC32v2: upper switches PB6, PB7, PB8, lower ones PA7, PB0, PB1, all on when high and
//            pulled low; analog inputs PA1, PA2, PA3 phases and PA4 bus through 1.5/11.5 dividers,
//            PA5 shunt 0.5 mohm x 50.9
//   Method   lazy: the motor runs up to each edge of a switch and each sampling instant
//            (plant/motor/switched_motor.hpp); the supply feeds a capacitor through its resistance, in
//            closed form for the mean current of a step
//   Shoot    both switches of a leg on for any time at all: told, with leg and duration; the leg
//            conducts to ground meanwhile, the short circuit itself is not computed
//   Error    energy books against the motor's own; free-running speed (tests/power_stage_test.cpp)
//   Left out gate delays and dead time of the drivers, ringing, slew of the switches
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <string>

#include "io_bridges/devices/event_queue.hpp"
#include "io_bridges/devices/wire.hpp"
#include "io_bridges/messages/messages.hpp"
#include "plant/motor/switched_motor.hpp"
#include "plant/sensors/current_shunt.hpp"

namespace whirl::rack {

using io::Nanoseconds;

struct PowerStageParams {
  plant::MotorParams motor;
  plant::CurrentShuntParams shunt;
  double bus_capacitance_F = 470e-6;
  bool swap_wires = false;  // two of the motor's wires: it turns the other way
};

class PowerStage {
 public:
  static constexpr const char* kUpper_pins[3] = {"PB6", "PB7", "PB8"};
  static constexpr const char* kLower_pins[3] = {"PA7", "PB0", "PB1"};
  static constexpr const char* kPhase_pins[3] = {"PA1", "PA2", "PA3"};
  static constexpr const char* kBus_pin = "PA4";
  static constexpr const char* kShunt_pin = "PA5";

  using Shot = std::function<void(int leg, Nanoseconds start_ns, Nanoseconds end_ns)>;

  PowerStage(const PowerStageParams& params, std::uint64_t seed, const std::string& name);
  PowerStage(const PowerStage&) = delete;
  PowerStage& operator=(const PowerStage&) = delete;

  void wire(int leg, bool upper, io::Wire& wire);  // the six switches, once each
  // Told once, when the motor has turned the other way for a while: the air's load is that of the
  // propeller's own direction only.
  void on_backwards(std::function<void(Nanoseconds)> told) { backwards_ = std::move(told); }
  void on_shoot_through(Shot shot) { shot_ = std::move(shot); }

  // At the converter's pins.
  double phase_V(int leg, Nanoseconds now);
  double bus_V(Nanoseconds now);
  double shunt_V(Nanoseconds now);

  void set_load(const io::ShaftLoad& load, Nanoseconds now);
  io::ShaftState report(Nanoseconds now);  // and starts the next report

  const plant::SwitchedMotor& motor() const { return motor_; }

 private:
  std::size_t phase_at(std::size_t leg) const;  // the motor's phase on that leg
  void advance(Nanoseconds now);
  struct Feed {  // of a step
    double end_V, mean_V, charge_C, heat_J;
  };
  Feed feed(double bridge_A, double dt_s) const;
  void run(double dt_s);
  void watch_direction(double speed_radps, Nanoseconds now);
  void hold_or_turn();
  void switched(int leg, bool upper, bool on, Nanoseconds now);
  void end_shot(int leg, Nanoseconds now);

  PowerStageParams params_;
  plant::SwitchedMotor motor_;
  plant::CurrentShunt shunt_;
  std::array<std::array<bool, 2>, 3> on_{};  // [leg][upper]
  std::array<Nanoseconds, 3> both_since_{io::kNever, io::kNever, io::kNever};
  Shot shot_;
  std::function<void(Nanoseconds)> backwards_;
  int backward_reports_ = 0;  // in a row
  io::ShaftLoad load_;
  double bus_V_ = 0.0;
  Nanoseconds now_ns_ = 0, reported_ns_ = 0;
  plant::MotorBooks books_;
  io::ShaftState state_;
  double source_charge_C_ = 0.0, window_charge_C_ = 0.0, window_s_ = 0.0;
};

}  // namespace whirl::rack
