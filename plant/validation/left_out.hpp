// Propellers that the rotor has never seen: every measured one left out in turn.
//
//   How      the one left out gives its geometry and its static rows, never a row in flight; what is believed of
//            blades like it comes from the others' rows (plant/rotor/known_blades.hpp), once without it
//            and once without its whole make. Static rows are judged on every second speed, left out.
//   One row  of it in flight, as a propeller file may give it, beside that: what rest does not tell is one angle, and
//            one row at 0.7 of the J range tells it. Judged on all its points, that one among them
//   Points   all with J > 0.1 and positive efficiency; error and band: blade_score.hpp
//   In view  of the 44 that are known, 32: the form of the section, the length and shares of the likeness, the first
//            belief and the discrepancy were chosen on their scores; traits, their spread and the mean of the
//            left-out one are not. The other twelve, once a set to judge on, then joined them. The four of
//            data/unseen and the fifteen of data/outside had no part in anything: validate_strangers(),
//            validate_outside(), docs/unseen_propellers.md.
//   Source   [UiucProp]
#pragma once
#include <string>

#include "plant/rotor/known_blades.hpp"
#include "plant/validation/data_reader.hpp"
#include "plant/validation/report.hpp"

namespace whirl::plant {

struct MeasuredBlade {
  std::string name, make;
  bool drawn = false;
  std::vector<PropellerStation> stations;
  AxialBlade axial;
  PropellerDescription description;
  std::vector<MeasuredPoint> still, flying;
};
// All of an index (index.txt of data/propellers, unseen or outside), in its order.
std::vector<MeasuredBlade> measured_blades(const ReadData& read, const std::string& folder);

KnownBlades know(const std::vector<MeasuredBlade>& blades);

Report validate_left_out(const std::vector<MeasuredBlade>& all, const KnownBlades& known);
Report validate_in_view(const std::vector<MeasuredBlade>& all, const KnownBlades& known);
Report validate_strangers(const std::vector<MeasuredBlade>& strangers, const KnownBlades& known);
// Nobody had seen these fifteen when the form, the known and the band were settled.
Report validate_outside(const std::vector<MeasuredBlade>& strangers, const KnownBlades& known);
// That data/propellers/known.txt is what these measurements give.
Report validate_known(const KnownBlades& known, const std::string& text);

}  // namespace whirl::plant
