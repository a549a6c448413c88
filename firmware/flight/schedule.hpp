// Which task runs in which tick of 1 ms. The table repeats every 100 ms.
//
//   Set-points go out in the ticks 0, 20, 40 .. right after the attitude task that computed them.
//   Status reads come every 50 ms per ESC, at 2, 4, 6, 8 ms from the set-points' ticks or halfway
//   between them, so that no write ever waits for a read (a write of all four takes 0.5 ms).
//   The log is sampled at 150 Hz: in the ticks 4, 11 and 18 of each 20.
#pragma once
#include <cstdint>

namespace fw::schedule {

inline constexpr std::uint32_t kAttitudePeriod = 5, kPositionPeriod = 25, kSetpointPeriod = 20,
                               kStatusPeriod = 50, kTelemetryPeriod = 5, kGpsPeriod = 5,
                               kSensorPeriod = 10;
inline constexpr std::uint32_t kPositionTick = 3, kTelemetryTick = 2, kGpsTick = 1, kSensorTick = 9;

// How long the steps of those tasks are.
inline constexpr float kAttitudeStep_s = static_cast<float>(kAttitudePeriod) / 1000.0f;
inline constexpr float kPositionStep_s = static_cast<float>(kPositionPeriod) / 1000.0f;

constexpr bool attitude(std::uint32_t tick) {
  return tick % kAttitudePeriod == 0;
}
constexpr bool position(std::uint32_t tick) {
  return tick % kPositionPeriod == kPositionTick;
}
constexpr bool setpoints(std::uint32_t tick) {
  return tick % kSetpointPeriod == 0;
}
constexpr bool telemetry(std::uint32_t tick) {
  return tick % kTelemetryPeriod == kTelemetryTick;
}
constexpr bool gps(std::uint32_t tick) {
  return tick % kGpsPeriod == kGpsTick;
}
constexpr bool sensors(std::uint32_t tick) {
  return tick % kSensorPeriod == kSensorTick;
}

constexpr bool log(std::uint32_t tick) {
  const std::uint32_t phase = tick % 20;
  return phase == 4 || phase == 11 || phase == 18;
}

// The motor (0..3) whose status is read in this tick, or -1.
constexpr int status_read(std::uint32_t tick) {
  const std::uint32_t phase = tick % kStatusPeriod;
  return phase >= 2 && phase <= 8 && phase % 2 == 0 ? static_cast<int>(phase / 2 - 1) : -1;
}

}  // namespace fw::schedule
