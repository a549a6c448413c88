// A clock for tests: time passes when it is told to, and where somebody sleeps.
#pragma once
#include <algorithm>

#include "harness/pacing/host_clock.hpp"

namespace whirl::pacing {

struct ToldClock final : HostClock {
  std::int64_t t_ns = 5'000'000'000;
  std::int64_t now_ns() const override { return t_ns; }
  void sleep_until(std::int64_t until_ns) override { t_ns = std::max(t_ns, until_ns); }
  void wait_for(std::span<pollfd> files, std::int64_t until_ns) override {
    if (poll(files.data(), files.size(), 0) == 0) sleep_until(until_ns);
  }
};

}  // namespace whirl::pacing
