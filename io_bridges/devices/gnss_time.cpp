#include "io_bridges/devices/gnss_time.hpp"

#include <chrono>

namespace whirl::io {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kWeek_ns = 7 * 86400 * kSecond_ns;

}  // namespace

GpsTime later(const GpsTime& time, std::int64_t ns) {
  const std::int64_t tow_ns = time.tow_ns + ns;
  return {time.week + static_cast<int>(tow_ns / kWeek_ns), tow_ns % kWeek_ns};
}

UtcTime utc_of(const GpsTime& time, int leap_s) {
  using namespace std::chrono;
  const nanoseconds since_epoch{time.week * kWeek_ns + time.tow_ns - leap_s * kSecond_ns};
  const sys_days epoch{year{1980} / January / 6};
  const auto days_passed = floor<days>(since_epoch);
  const year_month_day date{epoch + days_passed};
  const std::int64_t of_day_ns = (since_epoch - days_passed).count();
  const std::int64_t of_day_s = of_day_ns / kSecond_ns;
  return {static_cast<int>(date.year()),
          static_cast<int>(static_cast<unsigned>(date.month())),
          static_cast<int>(static_cast<unsigned>(date.day())),
          static_cast<int>(of_day_s / 3600),
          static_cast<int>(of_day_s / 60 % 60),
          static_cast<int>(of_day_s % 60),
          static_cast<std::int32_t>(of_day_ns % kSecond_ns)};
}

}  // namespace whirl::io
