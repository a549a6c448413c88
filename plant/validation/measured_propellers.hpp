// The rotor against propellers measured in a wind tunnel.
//
//   What is fitted   per propeller one tip twist, on its static thrust alone. Per family the sections.
//                    For all, the induced power factor 1.15 and lift as Re^0.1 below the polars.
//                    Sections and these two were settled with flight data of these same four
//                    propellers in view: only other propellers can test that choice.
//   Limits           weighted mean errors: static CT 5 %, CP 10 %; forward CT 10 %, CP 12 %
//   Left-out figures the same with the twist of the family's other propellers (no fit at all on the
//                    propeller in question), and without any twist correction: as notes
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

// Sections by make, chosen once per family: APC and GWS slow flyers.
std::vector<SectionStation> family_sections(const std::string& propeller, const SectionOf& section);

Report validate_measured_propellers(const ReadData& read);
// Propellers whose flight data nobody had in view when the rules were settled.
Report validate_unseen_propellers(const ReadData& read);

}  // namespace whirl::plant
