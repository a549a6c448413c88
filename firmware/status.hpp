// What a firmware call can answer. No exceptions, no heap, no strings: a byte, and it must be
// looked at. Anything that was survived is counted in Faults and flown home in SYS_STATUS.
#pragma once
#include <cstdint>

namespace fw {

enum class [[nodiscard]] Status : std::uint8_t{
    ok,
    busy,         // try again on the next tick; nothing is wrong
    no_answer,    // the bus gave up, or the address was not acknowledged
    wrong_id,     // something answered, but not the part we were built for
    bad_data,     // CRC, range or sequence check failed
    config_lost,  // a register no longer holds what we wrote
};

struct Faults {                        // never decremented by firmware
  std::uint32_t imu_samples_lost = 0;  // ticks of the fallback timer while the IMU should run
  std::uint32_t imu_frozen = 0;        // the same 14 bytes for longer than noise allows
  std::uint32_t imu_saturated = 0;     // a rate at its rail; the sample was not used
  std::uint32_t imu_reconfigured = 0;  // a register had lost its setting
  std::uint32_t esc_no_answer = 0;     // transactions that failed, retries included
  std::uint32_t esc_bad_status = 0;    // status reads with a wrong CRC
  std::uint32_t i2c_recoveries = 0;    // nine-clock recoveries of the bus
  std::uint32_t i2c_timeouts = 0;
  std::uint32_t baro_failures = 0, mag_failures = 0;  // transactions and readings
  std::uint32_t sensor_reconfigured = 0;  // barometer, magnetometer or GPS had to be set up anew
  std::uint32_t gps_searches = 0;         // for a receiver that stopped, beside the first
  std::uint32_t gps_bad_frames = 0;
  std::uint32_t link_bad_frames = 0;  // frames with a wrong CRC
  std::uint32_t link_overruns = 0;    // telemetry dropped because the queue was full
  std::uint32_t deadline_missed = 0;  // ticks that started while the one before still ran
};

}  // namespace fw
