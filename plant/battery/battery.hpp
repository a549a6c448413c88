// A pack: open-circuit voltage by charge, two relaxation branches, series resistance.
//
//   Units   SI; current is positive out of the pack, charging is allowed
//   Method  relaxation branches by their exact exponential for a constant current and resistance over
//           the step
//   Valid   one temperature, one age; below empty the last slope goes on down to 0 V, the resistances
//           stay those of an empty pack
//   Error   relaxation, charge and energy against closed form (tests/battery_test.cpp); a pouch cell's
//           discharges, fitted up to 1 C, at 2 C [Enertech]: 21 mV rms, 37 mV at worst of each cell
//           (plant/validation/discharge_proof.hpp)
//   Left out warming by its own current (that is what is missing at 2 C: the cell is better than
//           told), hysteresis, ageing, cells that differ
#pragma once
#include "plant/battery/battery_params.hpp"

namespace whirl::plant {

struct BatteryBooks {         // energy of one draw
  double chemical_J = 0.0;    // open-circuit voltage at its start x charge
  double series_J = 0.0;      // heat of the series resistance
  double relaxation_J = 0.0;  // into the relaxation branches: heat and what they store
  double dip_J = 0.0;         // taken by a dip that a plan imposes
  BatteryBooks& operator+=(const BatteryBooks& other);
};

class Battery {
 public:
  explicit Battery(const BatteryParams& params);

  double open_circuit_V() const;                          // at the present charge, rested
  double source_V() const { return source_V_ - dip_V_; }  // behind the series resistance
  double series_resistance_ohm() const { return series_ohm_; }
  double settled_resistance_ohm() const;  // what a current costs that has lasted
  double charge_used_C() const { return used_C_; }
  double depth_of_discharge() const;

  BatteryBooks draw(double charge_C, double dt_s);
  void set_dip(double below_V) { dip_V_ = below_V; }

 private:
  struct Branch {
    double ohm = 0.0, time_s = 1.0;  // ohm: at factor 1
    double voltage_V = 0.0;
    double blend = 0.0;  // of the last step's length
  };
  void look_up();  // what goes with the present charge

  BatteryParams params_;
  double warmth_factor_ = 1.0;  // of the temperature, which stays
  double factor_ = 1.0, series_ohm_ = 0.0;
  Branch fast_, slow_;
  double used_C_ = 0.0, source_V_ = 0.0, dip_V_ = 0.0;
  double last_dt_s_ = 0.0;
};

}  // namespace whirl::plant
