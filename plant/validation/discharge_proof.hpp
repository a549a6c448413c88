// A pack against measured discharges of one of its cells.
//
//   In      the pack's numbers, how many of its cells are in series (one beside the other), rows of
//           plant/data/batteries: current / A, time / s, voltage / V of a cell that was full and rested
//   Judged  by current: rms of the cell's voltage, of what was kept aside also the worst
//   Source  [Enertech]
//   Limits  of what it was fitted on three times the scatter over that fit (6, 3 and 2 mV); at 2 C, twice the current of
//           anything that the fit saw, what 10 K of the cell's own warmth do to a fifth of its drop: the pack does
//           not warm
#pragma once
#include <string>

#include "plant/battery/battery_params.hpp"
#include "plant/validation/validation.hpp"

namespace whirl::plant {

Proof discharge_proof(const BatteryParams& pack, int cells, const std::string& rows);

}  // namespace whirl::plant
