// GPS time as a receiver writes it: week and time of week, and the UTC calendar.
//
//   Valid   weeks of 1980-01-06 on; leap seconds are the caller's
#pragma once
#include <cstdint>

namespace whirl::io {

struct GpsTime {
  int week = 0;
  std::int64_t tow_ns = 0;  // 0 .. one week
};
struct UtcTime {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, second = 0;
  std::int32_t nano_ns = 0;  // behind the second
};

GpsTime later(const GpsTime& time, std::int64_t ns);
UtcTime utc_of(const GpsTime& time, int leap_s);

}  // namespace whirl::io
