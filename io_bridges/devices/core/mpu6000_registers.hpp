// Register map of the MPU-6000, transcribed by hand from RM-MPU-6000A-00 rev 4.2. The flight image has
// a transcription of its own: a typo shared by both would agree with itself.
#pragma once
#include <cstdint>

#include "io_bridges/devices/core/register_file.hpp"

namespace whirl::core::mpu {

enum Address : std::uint8_t {
  PRODUCT_ID = 0x0C,
  SELF_TEST_X = 0x0D,
  SMPLRT_DIV = 0x19,
  CONFIG = 0x1A,
  GYRO_CONFIG = 0x1B,
  ACCEL_CONFIG = 0x1C,
  FIFO_EN = 0x23,
  INT_PIN_CFG = 0x37,
  INT_ENABLE = 0x38,
  INT_STATUS = 0x3A,
  ACCEL_XOUT_H = 0x3B,
  TEMP_OUT_H = 0x41,
  GYRO_XOUT_H = 0x43,
  GYRO_ZOUT_L = 0x48,
  EXT_SENS_DATA_23 = 0x60,
  SIGNAL_PATH_RESET = 0x68,
  USER_CTRL = 0x6A,
  PWR_MGMT_1 = 0x6B,
  PWR_MGMT_2 = 0x6C,
  FIFO_COUNT_H = 0x72,
  FIFO_COUNT_L = 0x73,
  FIFO_R_W = 0x74,
  WHO_AM_I = 0x75,
};

// INT_PIN_CFG, INT_ENABLE and INT_STATUS.
inline constexpr std::uint8_t kINT_LEVEL = 0x80, kINT_OPEN = 0x40, kLATCH_INT_EN = 0x20,
                              kINT_RD_CLEAR = 0x10;
inline constexpr std::uint8_t kFIFO_OFLOW = 0x10, kDATA_RDY = 0x01;
// USER_CTRL.
inline constexpr std::uint8_t kDMP_EN = 0x80, kFIFO_ENABLE = 0x40, kI2C_MST_EN = 0x20,
                              kI2C_IF_DIS = 0x10, kDMP_RESET = 0x08, kFIFO_RESET = 0x04,
                              kI2C_MST_RESET = 0x02, kSIG_COND_RESET = 0x01;
// PWR_MGMT_1.
inline constexpr std::uint8_t kDEVICE_RESET = 0x80, kSLEEP = 0x40, kCYCLE = 0x20, kTEMP_DIS = 0x08,
                              kCLKSEL = 0x07;
// FIFO_EN.
inline constexpr std::uint8_t kTEMP_FIFO_EN = 0x80, kXG_FIFO_EN = 0x40, kYG_FIFO_EN = 0x20,
                              kZG_FIFO_EN = 0x10, kACCEL_FIFO_EN = 0x08;

extern const RegisterMap kMap;

}  // namespace whirl::core::mpu
