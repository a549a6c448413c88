#include "harness/board/wire_ends.hpp"

#include <algorithm>
#include <cmath>

#include "io_bridges/board_description/bus_kind.hpp"

namespace whirl {

WireEnds wire_ends(const std::vector<WirePlace>& places, int fd) {
  WireEnds ends;
  for (const WirePlace& place : places) {
    const auto known = std::find_if(ends.following.begin(), ends.following.end(),
                                    [&](const WireEnd& end) { return end.bus == place.bus; });
    WireEnd end{.device = place.device,
                .fd = fd,
                .port = static_cast<int>(known - ends.following.begin()),
                .latency_ns = place.latency_ns};
    ends.leading.push_back(end);
    if (known != ends.following.end()) continue;
    end.device.clear();
    end.bus = place.bus;
    end.select = place.select;
    end.ready = place.ready;
    ends.following.push_back(std::move(end));
  }
  const bool shared = ends.following.size() > 1 ||
                      (!places.empty() && bus_kind(places.front().bus) == BusKind::spi);
  for (WireEnd& end : ends.following) end.shared = shared;
  return ends;
}

std::int64_t shortest_character_ns(double fastest_baud) {
  constexpr double kShortest_bits = 10.0 * 0.97;
  return std::llround(kShortest_bits * 1e9 / fastest_baud);
}

}  // namespace whirl
