// The MPU-6000's analogue side in figures: CONFIG.DLPF_CFG and the scales of its ranges.
//
//   Source  RM-MPU-6000A-00 rev 4.2, registers 26 to 28
#pragma once

namespace whirl::io::mpu {

// Bandwidth and delay of both sensors.
struct DlpfRow {
  double accel_Hz, accel_delay_s, gyro_Hz, gyro_delay_s;
};
inline constexpr DlpfRow kDlpf[] = {
    {260, 0.0000, 256, 0.00098}, {184, 0.0020, 188, 0.0019},  {94, 0.0030, 98, 0.0028},
    {44, 0.0049, 42, 0.0048},    {21, 0.0085, 20, 0.0083},    {10, 0.0138, 10, 0.0134},
    {5, 0.0190, 5, 0.0186},      {260, 0.0000, 256, 0.00098},  // 7 is reserved and taken as 0
};

inline constexpr double kAccel_counts_per_g[] = {16384, 8192, 4096, 2048};
inline constexpr double kGyro_counts_per_degps[] = {131, 65.5, 32.8, 16.4};

}  // namespace whirl::io::mpu
