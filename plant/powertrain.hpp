// What turns a vehicle's rotors: one shaft for each motor, what drives it, and the pack that feeds all.
//
//   Frame    shafts and motors by index = motor number - 1
//   Units    SI
//   Order    set_loads() and set_dip() say what holds from now on, t; step() is the time from t to
//            t + dt under that, and fills in the state at t + dt. Between two steps both are up to date
//   Kinds    averaged_powertrain.hpp: duties on the vehicle's own bus; remote_powertrain.hpp: shafts
//            that somebody else steps
//   Adding   one class; who makes the vehicle hands one over (Vehicle's second constructor)
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace whirl::plant {

struct ShaftLoad;  // plant/motor/averaged_motor.hpp

enum class Freewheel {
  synchronous,  // the low side conducts when the high side does not: current may reverse (brakes)
  diode,        // body diodes only: current never reverses; duty 0 coasts
};

struct MotorCommand {
  double duty = 0.0;  // 0..1 of the bus voltage
  Freewheel freewheel = Freewheel::diode;
  double short_A =
      0.0;  // past the winding, from the bus through the bridge, while the duty is not 0
};

struct MotorState {
  double speed_radps = 0.0;      // negative: the air turns the propeller backward
  double winding_peak_A = 0.0;   // largest magnitude within the step
  double bus_current_A = 0.0;    // mean over the step; negative when it feeds the pack
  double shaft_torque_Nm = 0.0;  // taken by the air: the rotor's, not the powertrain's to fill in
  double thrust_N = 0.0;         // likewise, and so what its blades do:
  double coning_rad = 0.0, flap_back_rad = 0.0, flap_left_rad = 0.0;
  double winding_temperature_K = 293.15;
  bool blocked = false;  // the propeller struck the ground and has stopped, or is being stopped
};

struct EnergyBooks {  // of one step: what the pack gave is the sum of the rest
  double chemical_J = 0.0;
  double battery_J = 0.0;  // heat and relaxation of the pack, and a dip that a plan imposes
  double avionics_J = 0.0;
  double short_J = 0.0;  // heat of what MotorCommand::short_A takes
  double copper_J = 0.0, diode_J = 0.0, no_load_J = 0.0;
  double magnetic_J = 0.0, kinetic_J = 0.0;  // what the windings and the shafts store
  double capacitor_J = 0.0;                  // and the capacitors of remote shafts' bridges
  double air_J = 0.0;                        // work of the shafts on the air
  double exchange_J = 0.0;  // between the pack and remote shafts, see remote_powertrain.hpp
};

struct PowertrainState {
  std::vector<MotorState> motors;  // index: motor number - 1
  double bus_voltage_V = 0.0;      // mean over the step
  double battery_current_A = 0.0;  // mean over the step, avionics included
  double charge_used_C = 0.0;
  EnergyBooks energy;
};

class Powertrain {
 public:
  virtual ~Powertrain() = default;

  virtual std::size_t count() const = 0;
  virtual double source_V() const = 0;  // of the pack at no current
  virtual double speed_radps(std::size_t motor) const = 0;

  virtual void set_speed(std::size_t motor, double speed_radps) = 0;
  virtual void block(
      std::size_t motor) = 0;  // its propeller has struck the ground, and stays there
  virtual void command(std::size_t motor, const MotorCommand& command) = 0;  // until the next one

  virtual void set_loads(std::span<const ShaftLoad> loads) = 0;  // one for each shaft
  virtual void set_dip(double below_V) = 0;                      // lowers the source
  // Pre: state.motors has one for each shaft.
  virtual void step(double dt_s, PowertrainState& state) = 0;
};

}  // namespace whirl::plant
