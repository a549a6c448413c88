#include "io_bridges/devices/core/mpu6000_registers.hpp"

namespace whirl::core::mpu {
namespace {

constexpr auto RW = Access::read_write;
constexpr auto RO = Access::read_only;
constexpr auto kDone = Depth::modelled;
constexpr auto kKept = Depth::stored_only;

struct Entry {
  std::uint8_t address;
  RegisterSpec spec;
};
constexpr Entry kSingle[] = {
    {PRODUCT_ID, {"PRODUCT_ID", RO, 0, kDone}},
    {0x0D, {"SELF_TEST_X", RW, 0, kKept}},
    {0x0E, {"SELF_TEST_Y", RW, 0, kKept}},
    {0x0F, {"SELF_TEST_Z", RW, 0, kKept}},
    {0x10, {"SELF_TEST_A", RW, 0, kKept}},
    {SMPLRT_DIV, {"SMPLRT_DIV", RW, 0, kDone}},
    {CONFIG, {"CONFIG", RW, 0, kDone}},
    {GYRO_CONFIG, {"GYRO_CONFIG", RW, 0, kDone}},
    {ACCEL_CONFIG, {"ACCEL_CONFIG", RW, 0, kDone}},
    {0x1F, {"MOT_THR", RW, 0, kKept}},
    {FIFO_EN, {"FIFO_EN", RW, 0, kDone}},
    {INT_PIN_CFG, {"INT_PIN_CFG", RW, 0, kDone}},
    {INT_ENABLE, {"INT_ENABLE", RW, 0, kDone}},
    {INT_STATUS, {"INT_STATUS", RO, 0, kDone}},
    {0x63, {"I2C_SLV0_DO", RW, 0, kKept}},
    {0x64, {"I2C_SLV1_DO", RW, 0, kKept}},
    {0x65, {"I2C_SLV2_DO", RW, 0, kKept}},
    {0x66, {"I2C_SLV3_DO", RW, 0, kKept}},
    {0x67, {"I2C_MST_DELAY_CTRL", RW, 0, kKept}},
    {SIGNAL_PATH_RESET, {"SIGNAL_PATH_RESET", Access::write_only, 0, kDone}},
    {0x69, {"MOT_DETECT_CTRL", RW, 0, kKept}},
    {USER_CTRL, {"USER_CTRL", RW, 0, kDone}},
    {PWR_MGMT_1, {"PWR_MGMT_1", RW, kSLEEP, kDone}},
    {PWR_MGMT_2, {"PWR_MGMT_2", RW, 0, kKept}},
    {FIFO_COUNT_H, {"FIFO_COUNTH", RO, 0, kDone}},
    {FIFO_COUNT_L, {"FIFO_COUNTL", RO, 0, kDone}},
    {FIFO_R_W, {"FIFO_R_W", RW, 0, kDone}},
    {WHO_AM_I, {"WHO_AM_I", RO, 0x68, kDone}},
};

constexpr RegisterMap build_map() {
  RegisterMap map{};
  for (const Entry& entry : kSingle) map[entry.address] = entry.spec;
  for (std::uint8_t a = 0x24; a <= 0x36; ++a) {
    map[a] = {"I2C_MST/I2C_SLV", a >= 0x35 ? RO : RW, 0, kKept};  // SLV4_DI, MST_STATUS
  }
  for (std::uint8_t a = ACCEL_XOUT_H; a <= GYRO_ZOUT_L; ++a) {
    map[a] = {"ACCEL/TEMP/GYRO_OUT", RO, 0, kDone};
  }
  for (std::uint8_t a = GYRO_ZOUT_L + 1; a <= EXT_SENS_DATA_23; ++a) {
    map[a] = {"EXT_SENS_DATA", RO, 0, kDone};  // zero: no auxiliary bus
  }
  return map;
}

}  // namespace

constinit const RegisterMap kMap = build_map();

}  // namespace whirl::core::mpu
