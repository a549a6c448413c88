#include "harness/pacing/host_clock.hpp"

#include <algorithm>
#include <ctime>

#include "base/check.hpp"

namespace whirl::pacing {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

}  // namespace

std::int64_t MonotonicClock::now_ns() const {
  timespec now{};
  WHIRL_CHECK(clock_gettime(CLOCK_MONOTONIC, &now) == 0);
  return now.tv_sec * kSecond_ns + now.tv_nsec;
}

void MonotonicClock::sleep_until(std::int64_t t_ns) {
  const timespec until{t_ns / kSecond_ns, t_ns % kSecond_ns};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

void MonotonicClock::wait_for(std::span<pollfd> files, std::int64_t t_ns) {
  const std::int64_t left_ns = std::max<std::int64_t>(0, t_ns - now_ns());
  const timespec left{left_ns / kSecond_ns, left_ns % kSecond_ns};
  ppoll(files.data(), files.size(), &left, nullptr);
}

}  // namespace whirl::pacing
