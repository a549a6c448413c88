// What an IMU's message on CAN (Imu14, Imu16) says to the part that the pod plays: counts, and which sample it is.
#pragma once
#include <algorithm>
#include <cstdint>

namespace fw::pod {

// Of a part whose ranges are powers of two below the widest (range 3).
constexpr std::int16_t part_counts(std::int32_t steps, unsigned range) {
  const std::int32_t counts = steps * (1 << (3 - range));
  return static_cast<std::int16_t>(std::clamp<std::int32_t>(counts, INT16_MIN, INT16_MAX));
}

// Numbers samples by their stamps of 10 us: one more for each period of 1 ms; and the same time in us.
class StampCounter {
 public:
  std::uint8_t number(std::uint32_t stamp, std::uint32_t span) {
    constexpr std::uint32_t kPeriod = 100;
    const std::uint32_t since = (stamp - last_) & (span - 1);
    last_ = stamp;
    now_us_ = static_cast<std::uint16_t>(now_us_ + 10 * since);
    number_ = static_cast<std::uint8_t>(number_ + (since + kPeriod / 2) / kPeriod);
    return number_;
  }
  std::uint16_t now_us() const { return now_us_; }

 private:
  std::uint32_t last_ = 0;
  std::uint16_t now_us_ = 0;
  std::uint8_t number_ = 0;
};

}  // namespace fw::pod
