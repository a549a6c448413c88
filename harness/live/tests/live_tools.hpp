// What the tests of the bridge share.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "harness/live/host_clock.hpp"
#include "io_bridges/protocols/mavlink_messages.hpp"

namespace whirl::live {

inline constexpr std::int64_t kMs = 1'000'000;
using Bytes = std::vector<std::uint8_t>;

// Time passes when it is told to, and where somebody sleeps.
struct ToldClock final : HostClock {
  std::int64_t t_ns = 5'000'000'000;
  std::int64_t now_ns() const override { return t_ns; }
  void sleep_until(std::int64_t until_ns) override { t_ns = std::max(t_ns, until_ns); }
};

inline Bytes heartbeat() {
  io::MavlinkSender sender;
  return io::encode(io::pack(io::Heartbeat{}, sender));
}

}  // namespace whirl::live
