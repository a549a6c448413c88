// Days and fields of the calendar that RTC keeps: 2000 to 2099, every fourth year is a leap year.
#pragma once
#include <cstdint>

namespace whirl::stm32 {

struct CivilDate {
  int year = 0;  // 0..99
  int month = 1, day = 1;
};

inline int days_in_month(int year, int month) {
  constexpr int kDays[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  return month == 2 && year % 4 == 0 ? 29 : kDays[(month - 1) % 12];
}

inline std::int64_t days_since_2000(const CivilDate& date) {
  std::int64_t days = date.year * 365 + (date.year + 3) / 4;
  for (int month = 1; month < date.month && month <= 12; ++month) {
    days += days_in_month(date.year, month);
  }
  return days + date.day - 1;
}

inline CivilDate date_of(std::int64_t days) {
  CivilDate date;
  days %= 36525;  // the century wraps
  while (days >= (date.year % 4 == 0 ? 366 : 365)) {
    days -= date.year % 4 == 0 ? 366 : 365;
    ++date.year;
  }
  while (days >= days_in_month(date.year, date.month)) {
    days -= days_in_month(date.year, date.month);
    ++date.month;
  }
  date.day = static_cast<int>(days) + 1;
  return date;
}

inline std::uint32_t to_bcd(std::int64_t value) {
  return static_cast<std::uint32_t>(value / 10 * 16 + value % 10);
}
inline int from_bcd(std::uint32_t bcd) {
  return static_cast<int>((bcd >> 4) * 10 + (bcd & 15));
}

}  // namespace whirl::stm32
