// MPU-6000, MS5611 and HMC5883L on a whole STM32F405, driven by an image in the manner of other people's drivers: by
// polling, interrupts and DMA. What is expected follows from the field and the motion that go in and from the data
// sheets' scales, times and worked examples.
#include <gtest/gtest.h>

#include "base/near.hpp"
#include "io_bridges/qemu/tests/image_report.hpp"

namespace whirl::board_test {
namespace {

// Parts without noise and spread. The first barometer holds the coefficients of its sheet's worked example.
ImageBoard sensors() {
  const std::string still = R"("params.noise":0,"params.turn_on_bias":0,"params.drift":0)";
  return {"sensors_style",
          R"(,{"name":"imu","type":"mpu6000","bus":"spi1","cs":"PB0","int":"PC3",)"
          R"("params.accelerometer.noise_density":0,"params.accelerometer.bias_instability":0,)"
          R"("params.accelerometer.turn_on_bias":0,"params.accelerometer.scale_error":0,)"
          R"("params.gyroscope.noise_density":0,"params.gyroscope.bias_instability":0,)"
          R"("params.gyroscope.turn_on_bias":0,"params.gyroscope.scale_error":0})"
          R"(,{"name":"sheet","type":"ms5611","bus":"spi2","cs":"PB12","params.c1":40127,)"
          R"("params.c2":36924,"params.c3":23317,"params.c4":23282,"params.c5":33464,)"
          R"("params.c6":28312,)" +
              still + R"(},{"name":"drawn","type":"ms5611","bus":"i2c2","address":119,)" + still +
              R"(},{"name":"mag","type":"hmc5883l","bus":"i2c2","address":30,"drdy":"PB1",)"
              R"("axes":["+y","-x","+z"],"params.noise":0})"};
}

// The sheet's 1000.09 mbar and 20.07 degC; 1, -2 m/s2 and g; half a radian a second; 20, 5, -50 uT.
void tell_what_is_sensed(int millisecond, io::Batch& sensed) {
  if (millisecond != 0) return;
  io::BodyMotion motion;
  const double force[3] = {1.0, -2.0, -9.80665}, rate[3] = {0.5, -0.25, 0.1};
  const double field[3] = {20e-6, 5e-6, -50e-6};
  for (int i = 0; i < 3; ++i) {
    motion.specific_force_B_mps2[i] = force[i];
    motion.w_WB_B_radps[i] = rate[i];
    motion.magnetic_field_B_T[i] = field[i];
  }
  motion.static_pressure_Pa = 100009.0;
  motion.air_temperature_K = 293.22;
  sensed.add(io::Kind::body_motion, 0, 0, motion);
}

double told(const Values& values, std::size_t i) {
  return static_cast<double>(values.at(i)) - 1e6;
}

// What several tests look at is flown once.
const ImageRun& flown() {
  static const ImageRun run = run_image(sensors(), 4000, tell_what_is_sensed);
  return run;
}

const Values& reported(const std::string& name) {
  static const Values none;
  const auto found = flown().report.find(name);
  return found == flown().report.end() ? none : found->second;
}

TEST(SensorImages, NothingIsAmissButWhatTheImageDoesOnPurpose) {
  ASSERT_EQ(flown().error, "");
  EXPECT_EQ(flown().faults, 0);
  EXPECT_EQ(reported("i2c_errors"), Values{0});
  std::string on_purpose;
  for (const std::string part : {"sheet", "drawn"}) {
    on_purpose += part + std::string(1, '\0') + "ADC read with no result waiting: it reads 0\n" +
                  part + std::string(1, '\0') +
                  "ADC read while it converts: it reads 0, and the result to come is wrong\n";
  }
  EXPECT_EQ(flown().findings, on_purpose);
}

TEST(SensorImages, AutoQuadsImuIsReadByDmaOnEachDataReady) {
  EXPECT_EQ(reported("imu_reset"), Values{0x40});
  EXPECT_EQ(reported("imu_tries"), Values{2});
  EXPECT_EQ(reported("imu_who"), Values{0x68});
  EXPECT_EQ(reported("imu_settings"), Values{6});
  expect_between(1584, reported("imu_bursts"),
                 1616);  // 200 ms at 8 kHz, whose clock may be 1 % off
  const Values& mean = reported("imu_mean");
  ASSERT_EQ(mean.size(), 7u);
  const double g = 4096 / 9.80665, dps = 32.8 * 57.29578;
  const double want[7] = {1.0 * g,   2.0 * g,    9.80665 * g, (20.07 - 36.53) * 340,
                          0.5 * dps, 0.25 * dps, -0.1 * dps};
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_TRUE(near(told(mean, i), want[i], stated(2, "rounding of the part and of the mean")));
  }
}

TEST(SensorImages, TheSheetsBarometerGivesTheCountsOfItsExampleOnSpi) {
  EXPECT_EQ(reported("baro_crc"), (Values{1, 1}));
  ASSERT_EQ(reported("baro_d1").size(), 2u);
  // A pascal is 52 counts of D1 there, 0.01 degC are 296 of D2 and 101 of D1; both were rounded downwards.
  EXPECT_TRUE(near(reported("baro_d1")[0], 9085466, stated(52 + 101, "the example's last digits")));
  EXPECT_TRUE(near(reported("baro_d2")[0], 8569150, stated(297, "the example's last digit")));
}

TEST(SensorImages, BothBarometersGiveTheSamePressureByBothBuses) {
  const Values &pressure = reported("baro_pressure"), &temperature = reported("baro_temperature");
  ASSERT_EQ(pressure.size(), 2u);
  ASSERT_EQ(temperature.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_TRUE(near(pressure[i], 100009, stated(2, "a count, rounded downwards")));
    EXPECT_TRUE(near(told(temperature, i), 2007, stated(1, "0.01 degC, rounded downwards")));
  }
}

TEST(SensorImages, ABarometerThatWasNotAskedOrIsNotDoneReadsZero) {
  EXPECT_EQ(reported("baro_unasked"), (Values{0, 0}));
  EXPECT_EQ(reported("baro_again"), (Values{0, 0}));
  EXPECT_EQ(reported("baro_too_early"), (Values{0, 0}));
}

TEST(SensorImages, TheMagnetometerTellsItsFieldInTheOrderXZY) {
  EXPECT_EQ(reported("mag_identity"), Values{0x483433});
  expect_between(29, reported("mag_ready"), 31);  // 400 ms at 75 Hz
  const Values& field = reported("mag");
  ASSERT_EQ(field.size(), 3u);
  const double want[3] = {0.05 * 1090, -0.5 * 1090, -0.2 * 1090};  // +y, +z, -x of the body
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(near(told(field, i), want[i], stated(1, "a count")));
  }
}

TEST(SensorImages, TheMagnetometersSelfTestGivesTheSheetsCounts) {
  const Values& test = reported("mag_test");
  ASSERT_EQ(test.size(), 3u);
  const double want[3] = {452, 421, 452};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(near(told(test, i), want[i], stated(1, "a count")));
  }
}

}  // namespace
}  // namespace whirl::board_test
