// How the proofs come by the files of plant/data.
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "plant/rotor/polar.hpp"

namespace whirl::plant {

// Text of a file by its path under plant/data.
using ReadData = std::function<std::string(const std::string& path)>;
// Section by its name ("e63"), read once.
using SectionOf = std::function<std::shared_ptr<const PolarFamily>(const std::string& name)>;
SectionOf section_reader(ReadData read);

}  // namespace whirl::plant
