// Propellers that the rotor has never seen: every measured one left out in turn.
//
//   How      the one left out gives its geometry and its static rows, never a row in flight; what is believed of
//            blades like it comes from the others' rows (plant/rotor/known_blades.hpp), once without it
//            and once without its whole make. Static rows are judged on every second speed, left out.
//   One row  of it in flight, as a propeller file may give it, beside that: what rest does not tell is one angle, and
//            one row at 0.7 of the J range tells it. Judged on all its points, that one among them
//   Error    sum of |error| over sum of |measured|, over all points with J > 0.1 and positive efficiency
//   Band     stated 90 %: share of measured points inside, half-width over the mean of the measured
//   In view  the form of the section, the length and shares of the likeness, the first belief and the discrepancy
//            were chosen on these scores of all 32; traits, their spread and the mean of the left-out
//            one are not. The four of data/unseen and the twelve of data/third had no part in anything:
//            validate_strangers(), validate_third().
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
// All of an index (data/propellers/index.txt, data/unseen/index.txt), in its order.
std::vector<MeasuredBlade> measured_blades(const ReadData& read, const std::string& folder);

KnownBlades know(const std::vector<MeasuredBlade>& blades);

Report validate_left_out(const std::vector<MeasuredBlade>& all, const KnownBlades& known);
Report validate_in_view(const std::vector<MeasuredBlade>& all, const KnownBlades& known);
Report validate_strangers(const std::vector<MeasuredBlade>& strangers, const KnownBlades& known);
// Nobody had seen these twelve when the form, the band and the limits of a row in flight were set.
Report validate_third(const std::vector<MeasuredBlade>& strangers, const KnownBlades& known);
// That data/propellers/known.txt is what these measurements give.
Report validate_known(const KnownBlades& known, const std::string& text);

}  // namespace whirl::plant
