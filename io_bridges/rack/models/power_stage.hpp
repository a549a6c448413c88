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
//   Converter  each channel as its pin shows it: divider of real resistors, then gain, offset and noise
//            referred to the pin (PinErrors)
//   Error    energy books against the motor's own; free-running speed (tests/power_stage_test.cpp)
//   Left out gate delays and dead time of the drivers, ringing, slew of the switches; crosstalk between
//            channels: 1.3 kohm of divider and 1 kohm of switch charge the 8 pF of the sampling capacitor
//            in 18 ns, 1e-15 of the last channel is left after the 625 ns that it is given; the
//            converter's curvature (integral linearity, 1.5 counts)
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "io_bridges/devices/event_queue.hpp"
#include "io_bridges/devices/wire.hpp"
#include "io_bridges/messages/messages.hpp"
#include "io_bridges/rack/models/pwm_window.hpp"
#include "plant/motor/switched_motor.hpp"
#include "plant/sensors/current_shunt.hpp"

namespace whirl::rack {

using io::Nanoseconds;

struct PinErrors {       // of one channel, as the converter shows it
  double divider = 0.0;  // share by which its divider's ratio is off; none before the shunt's pin
  double gain = 0.0;     // of converter and reference, as a share
  double offset_V = 0.0;
  double noise_V = 0.0;  // standard deviation per conversion
};

struct PowerStageParams {
  plant::MotorParams motor;
  plant::CurrentShuntParams shunt;
  double bus_capacitance_F = 470e-6;
  double bus_esr_ohm = 0.0;  // in series with it
  bool swap_wires = false;   // two of the motor's wires: it turns the other way
  // Of the pins of phases a, b, c, bus and shunt.
  static constexpr std::size_t kPins = 5, kBus = 3, kShunt = 4;
  std::array<PinErrors, kPins> pins;
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
  double at_pin(std::size_t pin, double volts, double nominal);
  std::size_t phase_at(std::size_t leg) const;  // the motor's phase on that leg
  void advance(Nanoseconds now);
  struct Feed {  // of a step
    double end_V, mean_V, charge_C, heat_J;
  };
  double way_gone(double dt_s) const;
  Feed feed(double bridge_A, double dt_s, double gone) const;
  double seen_V() const;
  double run(double dt_s);  // the charge that went into the bridge, C
  void watch_direction(double speed_radps, Nanoseconds now);
  void hold_or_turn();
  void switched(int leg, bool upper, bool on, Nanoseconds now);
  void end_shot(int leg, Nanoseconds now);

  PowerStageParams params_;
  plant::SwitchedMotor motor_;
  plant::CurrentShunt shunt_;
  mutable plant::RememberedExp charging_;    // of the capacitor
  std::vector<RandomStream> noise_;          // of the pins
  std::array<std::array<bool, 2>, 3> on_{};  // [leg][upper]
  std::array<Nanoseconds, 3> both_since_{io::kNever, io::kNever, io::kNever};
  Shot shot_;
  std::function<void(Nanoseconds)> backwards_;
  int backward_reports_ = 0;  // in a row
  io::ShaftLoad load_;
  double bus_V_ = 0.0;        // at the bridge
  double capacitor_V_ = 0.0;  // inside: bus_V_ where it has no resistance in series
  Nanoseconds now_ns_ = 0, reported_ns_ = 0;
  plant::MotorBooks books_;
  io::ShaftState state_;
  double source_charge_C_ = 0.0;
  PwmWindow window_;
};

}  // namespace whirl::rack
