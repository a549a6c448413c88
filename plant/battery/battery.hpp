// A pack: open-circuit voltage by charge, one relaxation branch, series resistance.
//
//   Units   SI; current is positive out of the pack, charging is allowed
//   Method  relaxation branch by its exact exponential for a constant current over the step
//   Valid   one temperature, one age; below empty the last slope goes on down to 0 V
//   Error   relaxation, charge and energy against closed form (tests/battery_test.cpp)
#pragma once
#include "plant/battery/battery_params.hpp"

namespace whirl::plant {

struct BatteryBooks {         // energy of one draw
  double chemical_J = 0.0;    // open-circuit voltage at its start x charge
  double series_J = 0.0;      // heat of the series resistance
  double relaxation_J = 0.0;  // into the relaxation branch: heat and what it stores
  double dip_J = 0.0;         // taken by a dip that a plan imposes
  BatteryBooks& operator+=(const BatteryBooks& other);
};

class Battery {
 public:
  explicit Battery(const BatteryParams& params);

  double open_circuit_V() const;                          // at the present charge, rested
  double source_V() const { return source_V_ - dip_V_; }  // behind the series resistance
  double series_resistance_ohm() const { return params_.series_resistance_ohm; }
  double charge_used_C() const { return used_C_; }
  double depth_of_discharge() const;

  BatteryBooks draw(double charge_C, double dt_s);
  void set_dip(double below_V) { dip_V_ = below_V; }

 private:
  BatteryParams params_;
  double used_C_ = 0.0, relaxation_V_ = 0.0, source_V_ = 0.0, dip_V_ = 0.0;
  double last_dt_s_ = 0.0, last_blend_ = 0.0;
};

}  // namespace whirl::plant
