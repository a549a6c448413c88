// A millisecond in the nanoseconds of the tests of flight.
#pragma once
#include <cstdint>

namespace whirl::flight {

inline constexpr std::int64_t kMs = 1'000'000;

}  // namespace whirl::flight
