// The host's monotonic clock, and a sleep until one of its times; tests bring their own.
#pragma once
#include <poll.h>

#include <cstdint>
#include <span>

namespace whirl::pacing {

class HostClock {
 public:
  virtual ~HostClock() = default;
  virtual std::int64_t now_ns() const = 0;
  // Returns at once where that time has passed, and early where a signal comes.
  virtual void sleep_until(std::int64_t t_ns) = 0;
  // Until then, or until one of these files is ready.
  virtual void wait_for(std::span<pollfd> files, std::int64_t t_ns) = 0;
};

class MonotonicClock final : public HostClock {
 public:
  std::int64_t now_ns() const override;
  void sleep_until(std::int64_t t_ns) override;
  void wait_for(std::span<pollfd> files, std::int64_t t_ns) override;
};

}  // namespace whirl::pacing
