// What the tests of the bridge share.
#pragma once
#include <cstdint>
#include <vector>

#include "harness/pacing/tests/told_clock.hpp"
#include "io_bridges/protocols/mavlink_messages.hpp"

namespace whirl::live {

inline constexpr std::int64_t kMs = 1'000'000;
using pacing::ToldClock;
using Bytes = std::vector<std::uint8_t>;

inline Bytes heartbeat() {
  io::MavlinkSender sender;
  return io::encode(io::pack(io::Heartbeat{}, sender));
}

}  // namespace whirl::live
