// From power to thrust: the constants of the ESC's thrust model, by the thesis's procedure.
//
//   Model    CT = c1 (c2 - lambda), CT = c4 li lambda, lambda = li + ls,
//            CP = c3 + CT (kappa li + ls) c0, kappa = d0 + d1 CT
//            CT = T/w^2, CP = P/w^3, inflow ratios over w R with the blade's R; c4 = 2 rho A R^2
//   Scale    CT and CP of a point are over those of still air at its own speed (the ESC's maps), times
//            those at one middle speed: Reynolds number is the maps' matter, inflow is the model's;
//            the power that inflow takes is also scaled by 1 + speed_effect (w / middle - 1)
//   Power    by the ESC's own power balance (firmware/esc/core/power_balance.hpp), but with the stand's ammeter: the
//            ESC's own current wanders by more than inflow changes it
//   Order    c3 from the torque where thrust is zero; c1, c2 by a line of CT over lambda through still
//            air; then c0, d0, d1 and the speed's effect in one regression on
//            CP - c3 = c0 CT ls + c0 d0 CT li + c0 d1 CT^2 li + speed_effect (still CP - CP)
//            (w / middle - 1)
//            with ls where that line has the measured CT: what the line misses of inflow does not
//            spoil the way from power to thrust. (The thesis turns the last two about.)
//   Source   [Bangura 2017, 5.3.3]
#pragma once
#include "harness/calibrate/identify.hpp"

namespace whirl::calibrate {

struct RotorPoint {
  double wind_mps, speed_radps, thrust_N;
  double CT, CP;  // scaled
  double ls, li;  // as blown, and induced by the measured thrust
  double kappa;   // what this point alone says, given c0 and c3
};

struct RotorFit {
  Coefficient c0, c1, c2, c3, d0, d1, speed_effect;
  double c4 = 0.0;
  Range range_radps;  // of the ESC's power-based modes: the working speeds and a little more
  double middle_radps = 0.0, still_CT = 0.0, still_CP = 0.0;  // what points are scaled to
  Fit zero, power, line;
  std::vector<RotorPoint> points;
};

// Inflow that thrust induces, by momentum theory: c4 li (li + ls) = CT. Pre: CT > 0.
double induced_inflow(double CT, double ls, double c4);

Result<RotorFit> fit_rotor(const StandData& data, const MotorFit& motor, const StillAirFit& still);

// A bad_input error unless coefficients are positive and no point needs less than ideal power.
Result<Done> physical(const RotorFit& fit, double radius_m);

}  // namespace whirl::calibrate
