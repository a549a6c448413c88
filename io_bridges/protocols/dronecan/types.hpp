// All data types that this project speaks.
#pragma once
#include "io_bridges/protocols/dronecan/assembler.hpp"

namespace whirl::io::dronecan {

std::span<const DataType> all_types();
// Null: none of ours.
const DataType* known_type(Kind kind, std::uint16_t type_id);

}  // namespace whirl::io::dronecan
