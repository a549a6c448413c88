// The motor as a bridge sees it: three windings in a star, their back-EMF by rotor angle, six
// switches with body diodes.
//
//   Angle    electrical, 0..2 pi; phase a's back-EMF crosses zero rising at 0, b and c follow by 120
//            and 240 degrees. Positive speed raises the angle.
//   Units    SI; parameters line-to-line as MotorParams, per phase inside (half of them)
//   Use      set_bridge() at every edge of a switch, run() up to the next edge or sampling instant,
//            then phase_voltages() as an ADC at that instant would find the terminals
//   Method   phase currents by exact exponentials at the mid-step angle; a diode's last current is an
//            event, found in closed form
//   Valid    any pattern, both senses of rotation; inner steps turn at most 2 electrical degrees
//   Error    power balance to 1e-4 of the throughput, closed forms (tests/switched_motor_test.cpp)
//   Phases   each has resistance and inductance in one proportion (PhaseErrors), so that L/R is one time
//            constant and the star point stays in closed form; cogging's work is booked as no-load loss
//   Left out saliency, dead time (the board's patterns bring their own), ringing
#pragma once
#include <array>

#include "plant/base/remembered_exp.hpp"
#include "plant/motor/averaged_motor.hpp"

namespace whirl::plant {

enum class Leg { off, low, high, pwm };

struct Bridge {
  std::array<Leg, 3> leg{Leg::off, Leg::off, Leg::off};
  bool pwm_on = false;       // what Leg::pwm means now: on is high
  bool synchronous = false;  // and off is low (else the diodes)
};

// The pattern of sector 0..5: sector s is right from 30 + 60 s to 90 + 60 s electrical degrees.
Bridge six_step(int sector, bool pwm_on, bool synchronous);
int sector_of(double angle_rad);

class SwitchedMotor {
 public:
  explicit SwitchedMotor(const MotorParams& params);

  void set_bridge(const Bridge& bridge);
  void set_bus(double bus_V) { bus_V_ = bus_V; }
  void set_load(const ShaftLoad& load) { load_ = load; }  // opposes rotation, w |w|
  void set_speed(double speed_radps) { speed_ = speed_radps; }
  void set_angle(double electrical_rad);
  void block() { blocked_ = true, speed_ = 0.0, acceleration_ = 0.0; }
  void release() { blocked_ = false; }

  MotorBooks run(double dt_s);
  // Winding, magnets and bearings after dt_s in which `books` came together; nothing without a heat capacity.
  void warm(const MotorBooks& books, double dt_s);
  double winding_temperature_K() const { return temperature_K_; }

  std::array<double, 3> phase_voltages() const;  // terminals against the bus's negative, V
  const std::array<double, 3>& phase_currents_A() const { return current_; }  // into the motor
  double bus_current_A() const;                                               // at this instant
  // Its mean over the time to come, as far as can be said before it is run: the rotor does not turn meanwhile.
  double coming_bus_current_A(double dt_s) const;
  double peak_current_A() const { return peak_A_; }  // largest phase current since the last clear
  void clear_peak() { peak_A_ = 0.0; }
  double speed_radps() const { return speed_; }
  double electrical_angle_rad() const { return angle_; }

 private:
  struct Circuit;
  Circuit circuit(double angle, double speed) const;
  bool conducts(int phase, Circuit& c) const;
  double advance(double dt_s, MotorBooks& books);
  void turn(double impulse_Nms, double dt_s, double angle_gain, MotorBooks& books);
  double along(int phase, double charge_C) const;
  double back_emf(int phase, double angle) const;  // V s/rad of the shaft
  double impedance(int phase) const { return 1.0 + params_.phases.impedance[phase]; }

  MotorParams cold_, params_;  // as built, and at the winding's temperature
  double temperature_K_;
  Bridge bridge_;
  bool patterned_ = false;            // one leg of the bridge is driven and another one low
  std::array<double, 3> admittance_;  // of each phase, relative
  mutable RememberedExp settling_;    // of the windings' currents
  ShaftLoad load_;
  double bus_V_ = 0.0;
  std::array<double, 3> current_{};
  double angle_ = 0.0, speed_ = 0.0, acceleration_ = 0.0, peak_A_ = 0.0;
  bool blocked_ = false;
};

}  // namespace whirl::plant
