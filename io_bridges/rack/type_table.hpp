// All types and keys as a table in Markdown: what `whirl devices` prints, and what the README of the
// test plans holds.
#pragma once
#include <string>

#include "io_bridges/rack/device_type.hpp"

namespace whirl::rack {

std::string type_table(const DeviceTypes& types);

}  // namespace whirl::rack
