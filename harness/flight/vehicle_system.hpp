// The vehicle's number on MAVLink, of its system and its component.
#pragma once
#include <cstdint>

namespace whirl::flight {

inline constexpr std::uint8_t kVehicle = 1;

}  // namespace whirl::flight
