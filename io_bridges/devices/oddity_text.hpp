// What a part of devices/core finds odd, in words for a person.
#pragma once
#include <cstdint>
#include <string>

#include "io_bridges/devices/bus.hpp"
#include "io_bridges/devices/core/register_file.hpp"

namespace whirl::io {

// `map`: of the part's registers, for their names; null where it has none.
std::string oddity_text(core::Oddity what, std::uint32_t detail, const core::RegisterMap* map);

}  // namespace whirl::io
