// A HID device as whoever drives it sees it: reports out, reports in, and the clock beside them.
//
//   Reports  begin with their number; where a device numbers none, what goes out begins with 0 and what
//            comes in has none. Nothing is padded here: a caller writes the length that its chip wants
//   Time     monotonic nanoseconds; pause() passes some of it. In memory it is virtual
//   Errors   ErrorKind::host: the device is gone. A read that nothing answered in time is empty, no error
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/result.hpp"

namespace whirl::io {

using HidReport = std::vector<std::uint8_t>;

class HidPort {
 public:
  virtual ~HidPort() = default;
  virtual Result<Done> write(std::span<const std::uint8_t> report) = 0;
  virtual Result<HidReport> read(std::int64_t timeout_ns) = 0;
  virtual Result<HidReport> get_feature(std::uint8_t number, std::size_t length) = 0;
  virtual Result<Done> set_feature(std::span<const std::uint8_t> report) = 0;
  virtual Result<HidReport> report_descriptor() = 0;

  virtual std::int64_t now_ns() const = 0;
  virtual void pause_ns(std::int64_t duration_ns) = 0;
};

}  // namespace whirl::io
