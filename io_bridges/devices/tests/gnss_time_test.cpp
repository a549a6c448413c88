#include "io_bridges/devices/gnss_time.hpp"

#include <gtest/gtest.h>

#include <array>

namespace whirl::io {
namespace {

std::array<int, 6> calendar(const GpsTime& t, int leap_s) {
  const UtcTime utc = utc_of(t, leap_s);
  return {utc.year, utc.month, utc.day, utc.hour, utc.minute, utc.second};
}

// GPS time began with 6 January 1980 and rolled over 1024 weeks later, on 22 August 1999 (13 leap
// seconds), and again on 7 April 2019 (18).
TEST(GnssTime, KnownDays) {
  EXPECT_EQ(calendar({0, 0}, 0), (std::array<int, 6>{1980, 1, 6, 0, 0, 0}));
  EXPECT_EQ(calendar({1024, 0}, 13), (std::array<int, 6>{1999, 8, 21, 23, 59, 47}));
  EXPECT_EQ(calendar({2048, 18'000'000'000}, 18), (std::array<int, 6>{2019, 4, 7, 0, 0, 0}));
}

TEST(GnssTime, AWeekEndsAndTheFractionStays) {
  const GpsTime t = later({1800, 604'799'900'000'000}, 250'000'000);
  EXPECT_EQ(t.week, 1801);
  EXPECT_EQ(t.tow_ns, 150'000'000);
  EXPECT_EQ(utc_of(t, 16).nano_ns, 150'000'000);
}

}  // namespace
}  // namespace whirl::io
