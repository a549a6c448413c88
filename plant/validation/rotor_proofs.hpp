// Every proof of the rotor, ready to be printed and drawn.
#pragma once
#include "plant/validation/data_reader.hpp"
#include "plant/validation/validation.hpp"

namespace whirl::plant {

// `read` answers with the text of a file under plant/data. Takes about five seconds.
std::vector<Proof> rotor_proofs(const ReadData& read);

}  // namespace whirl::plant
