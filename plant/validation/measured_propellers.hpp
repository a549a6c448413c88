// The rotor against propellers measured in a wind tunnel.
//
//   What is fitted   per propeller one tip twist, on its static thrust alone. Sections by thickness
//                    (section_rules.hpp), one rule for all makes; GWS are of nylon and twist
//                    elastically (torsion.hpp). For all, the induced factor 1.15 in hover.
//                    These were settled with flight data of the four propellers in view: only
//                    others can test them (validate_unseen_propellers).
//   Limits           weighted mean errors: static CT 5 %, CP 10 %; forward CT 10 %, CP 12 %
//   Left-out figures the same with the twist of the make's other propeller, without any twist, with
//                    a degree more, and built as the other make is: as notes
//   Source           [UiucProp] and the polars of plant/data/polars
#pragma once
#include <functional>
#include <memory>

#include "plant/rotor/blade.hpp"
#include "plant/validation/report.hpp"

namespace whirl::plant {

// Text of a file by its path under plant/data.
using ReadData = std::function<std::string(const std::string& path)>;
// Section by its name ("e63"), read once.
using SectionOf = std::function<std::shared_ptr<const PolarFamily>(const std::string& name)>;
SectionOf section_reader(ReadData read);

Report validate_measured_propellers(const ReadData& read);
// Propellers that fitted nothing; which choices they had a part in all the same, the report says.
Report validate_unseen_propellers(const ReadData& read);

}  // namespace whirl::plant
