// The motor as a duty sees it: mean voltages and currents of a PWM period, torque, speed.
//
//   Units   SI; line-to-line, as MotorParams
//   State   the mean current of the conducting pair, which speed, drive and the commutations' dips,
//           tails and circling currents surround (commutation.hpp) as if they had settled
//   Method  Pair current by the exact exponential at the mean speed of the sub-step, speed by the
//           implicit midpoint rule: the energy books close to round-off and no step is unstable.
//           The bus pays for what the books say: duty x pair current less what commutations return
//   Valid   speed forward; sub-steps up to 0.5 ms; current shorter than a sector in the outgoing phase.
//           Backward (the air turns a propeller round): with all switches off no current flows; driven,
//           the back-EMF adds to the bridge's voltage, which is all that is told of commutation there
//   Source  [Bangura2017, 3.4] with the current read as bus current; [Erickson2001, ch. 5] for
//           discontinuous conduction
//   Error   power balance to round-off, closed forms to 1e-6 (tests/averaged_motor_test.cpp); against
//           the switched face 1 % in speed, torque, winding and bus current, but 2 % where the dips of
//           a sinusoidal motor run dry under diodes (tests/faces_test.cpp)
//   Left out magnetic saturation, current fed back through diodes at overspeed (an open bridge
//           conducts where the back-EMF exceeds the bus), timing other than neutral
#pragma once
#include "plant/motor/commutation.hpp"

namespace whirl::plant {

struct ShaftLoad {  // torque that the air takes at speed w: quadratic x w |w| + constant
  double quadratic_Nm_s2 = 0.0;  // not negative
  double constant_Nm = 0.0;
};

struct Drive {  // what the bridge does to the winding, mean over PWM periods
  double bus_V = 0.0;
  double duty = 0.0;
  bool diode = false;  // freewheel through diodes: current never reverses
};

struct Pulses {  // under diodes: what remains where the mean voltage would let the current run dry
  double least_A = 0.0;   // mean
  double least_A2 = 0.0;  // mean square
  double fall_A = 0.0;    // the share of the mean through the diodes
  double lasts_s = 0.0;   // centroid of a pulse: how long a lack of current lasts
  double falls_s = 1.0;   // how long after the pulse the current lasts
};

struct MotorBooks {  // one sub-step: charges and where the energy went
  double winding_charge_C = 0.0;
  double bus_charge_C = 0.0;
  double electrical_in_J = 0.0;  // bus voltage x bus charge
  double copper_J = 0.0;
  double diode_J = 0.0;
  double no_load_J = 0.0;
  double magnetic_J = 0.0;  // change of L i^2 / 2
  double kinetic_J = 0.0;   // change of J w^2 / 2
  double air_J = 0.0;
  double air_torque_Nm = 0.0;  // mean
  MotorBooks& operator+=(const MotorBooks& other);
};

class AveragedMotor {
 public:
  explicit AveragedMotor(const MotorParams& params);

  MotorBooks step(const Drive& drive, const ShaftLoad& load, double dt_s);

  // The same in two halves, for a bus voltage that depends on what all motors draw: try voltages,
  // then accept one. prepare() first, once per sub-step.
  struct Trial {
    MotorBooks books;
    double speed_radps = 0.0, current_A = 0.0;
  };
  void prepare(const Drive& about, double dt_s);  // the state and roughly the drive to come
  Trial attempt(const Drive& drive, const ShaftLoad& load, double dt_s) const;
  void accept(const Trial& trial) {
    rise_radps_ = trial.speed_radps - speed_;
    speed_ = trial.speed_radps, current_ = trial.current_A;
  }
  double bus_charge_per_volt(const Drive& drive, double dt_s) const;  // its slope, shaft held

  void block();  // the shaft is held and stands still from now on
  void set_speed(double speed_radps);
  void warm(const MotorBooks& books, double dt_s);  // winding temperature over a longer step

  bool blocked() const { return blocked_; }
  double speed_radps() const { return speed_; }
  double current_A() const { return current_; }
  double winding_temperature_K() const { return temperature_K_; }
  double resistance_ohm() const { return resistance_; }
  double running_ohm() const { return prepared_ohm_; }  // what the mean sees
  const MotorParams& params() const { return params_; }

 private:
  struct Winding;
  Winding conduct(double voltage_V, double dt_s) const;
  struct Motion {  // of the shaft over a sub-step
    double mean_radps = 0.0, friction_Nm = 0.0;
  };
  Motion move(const Winding& winding, const ShaftLoad& load, double dt_s) const;
  double balance(const Winding& winding, const ShaftLoad& load, double friction_Nm,
                 double dt_s) const;
  static void open_bridge(Winding& winding);
  void diode_limit(const Drive& drive, double dt_s, Winding& winding) const;
  void settle(const Winding& winding, double mean_radps, double dt_s, Trial& trial) const;

  MotorParams cold_, params_;              // as built, and at the winding's temperature
  double speed_ = 0.0, rise_radps_ = 0.0;  // the second over the last sub-step
  double current_ = 0.0;
  double temperature_K_;
  double resistance_;
  struct FoundFor {
    Drive drive;
    double speed_radps = 0.0, current_A = 0.0, ohm = 0.0, dt_s = 0.0;
    bool blocked = false;
  };
  bool still_holds(const Drive& about, double speed_radps, double dt_s) const;

  FoundFor found_for_;  // which state commutation_ and what follows are of
  Commutation commutation_;
  double prepared_ohm_ = 0.0, tau_s_ = 0.0, blend_ = 0.0;  // of the pair's mean current
  Pulses pulses_;
  bool blocked_ = false;
};

}  // namespace whirl::plant
