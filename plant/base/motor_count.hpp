// How many motors, and so rotors and ESCs, a vehicle may have.
#pragma once
#include <cstddef>

namespace whirl::plant {

inline constexpr std::size_t kMostMotors = 12;

}  // namespace whirl::plant
