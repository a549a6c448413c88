// The firmware's sensors on CAN against the host's codec, which another pen wrote.
#include "firmware/drivers/can_sensors.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "base/near.hpp"
#include "io_bridges/protocols/dronecan/assembler.hpp"
#include "io_bridges/protocols/dronecan/gnss.hpp"
#include "io_bridges/protocols/dronecan/imu_samples.hpp"
#include "io_bridges/protocols/dronecan/sensors.hpp"
#include "io_bridges/protocols/dronecan/vehicle_state.hpp"

namespace fw {
namespace {

namespace host = whirl::io::dronecan;
using whirl::near;
using whirl::stated;

struct SensorRig {
  CanSensors sensors;
  host::TransferIds ids;
  std::uint32_t now_us = 1'000'000;

  template <typename Message>
  std::vector<hal::CanFrame> frames(const Message& message, std::uint8_t source) {
    const host::Payload payload = host::encode(message);
    host::Header header{host::Kind::message, Message::kType.id, 16, source, 0, 0};
    header.transfer_id = ids.next(host::Kind::message, Message::kType.id, source);
    std::vector<hal::CanFrame> all;
    for (const auto& f : host::frames_of(header, Message::kType.signature, payload.bytes())) {
      all.push_back({f.id, f.length, f.data});
    }
    return all;
  }
  // Returns how many frames were the end of an inertial sample.
  template <typename Message>
  int hear(const Message& message, std::uint8_t source = 50, int drop = -1) {
    int ends = 0, n = 0;
    for (const hal::CanFrame& frame : frames(message, source)) {
      if (n++ == drop) continue;
      ends += sensors.is_imu_end(frame) ? 1 : 0;
      EXPECT_TRUE(sensors.on_frame(frame, now_us));
    }
    return ends;
  }
  template <typename Message>
  int sample(std::uint32_t stamp, int drop = -1, std::uint8_t source = 50) {
    Message message;
    message.rate = {1, -2, 3};
    message.acceleration = {-4, 5, -6};
    message.time = static_cast<std::uint16_t>(stamp);
    return hear(message, source, drop);
  }
};

TEST(CanSensors, SamplesOfBothWidthsAreInStepsOfSixteenBits) {
  SensorRig rig;
  EXPECT_EQ(rig.sample<host::Imu14>(100), 1);
  auto got = rig.sensors.take_imu();
  ASSERT_TRUE(got);
  EXPECT_EQ(got->rate, (std::array<std::int16_t, 3>{4, -8, 12}));
  EXPECT_EQ(got->acceleration, (std::array<std::int16_t, 3>{-16, 20, -24}));
  EXPECT_FALSE(rig.sensors.take_imu());
  SensorRig wide;
  EXPECT_EQ(wide.sample<host::Imu16>(100), 1);
  got = wide.sensors.take_imu();
  ASSERT_TRUE(got);
  EXPECT_EQ(got->rate, (std::array<std::int16_t, 3>{1, -2, 3}));
  EXPECT_EQ(got->acceleration, (std::array<std::int16_t, 3>{-4, 5, -6}));
}

TEST(CanSensors, ARateAtEitherRailIsSaturated) {
  for (const int rail : {8191, -8192}) {
    SensorRig rig;
    host::Imu14 message;
    message.rate[1] = static_cast<std::int16_t>(rail);
    rig.hear(message);
    EXPECT_TRUE(rig.sensors.take_imu()->rate_saturated());
    message.rate[1] = static_cast<std::int16_t>(rail > 0 ? rail - 1 : rail + 1);
    message.time = 7;
    rig.hear(message);
    EXPECT_FALSE(rig.sensors.take_imu()->rate_saturated());
  }
}

// Samples 1 to 999 periods apart: the stamps go round after 41 ms.
TEST(CanSensors, StampsTellHowManySamplesWereLostHoweverLong) {
  for (const std::uint32_t periods : {1u, 2u, 5u, 39u, 41u, 60u, 100u, 999u}) {
    SensorRig rig;
    rig.sample<host::Imu14>(4000);
    rig.now_us += 1000 * periods + 150;  // late on the wire
    rig.sample<host::Imu14>((4000 + 100 * periods) % 4096);
    EXPECT_EQ(rig.sensors.imu_lost(), periods - 1) << periods;
    EXPECT_TRUE(rig.sensors.take_imu());
  }
}

TEST(CanSensors, ASampleThatComesTwiceCountsOnce) {
  SensorRig rig;
  rig.sample<host::Imu14>(100);
  EXPECT_TRUE(rig.sensors.take_imu());
  rig.now_us += 1000;
  rig.sample<host::Imu14>(100);
  EXPECT_FALSE(rig.sensors.take_imu());
  EXPECT_EQ(rig.sensors.imu_repeated(), 1u);
  EXPECT_EQ(rig.sensors.imu_lost(), 0u);
}

TEST(CanSensors, ASampleWithoutItsFirstFrameIsNone) {
  SensorRig rig;
  rig.sample<host::Imu14>(100, 0);
  EXPECT_FALSE(rig.sensors.take_imu());
  rig.sample<host::Imu14>(200, 1);
  rig.sample<host::Imu14>(300);
  EXPECT_TRUE(rig.sensors.take_imu());
  EXPECT_EQ(rig.sensors.imu_bad(), 1u);
}

TEST(CanSensors, ASecondNodeIsNotHeardUntilTheFirstIsSilent) {
  SensorRig rig;
  EXPECT_EQ(rig.sample<host::Imu14>(100), 1);
  EXPECT_TRUE(rig.sensors.take_imu());
  EXPECT_EQ(rig.sample<host::Imu14>(200, -1, 60), 0);
  EXPECT_FALSE(rig.sensors.take_imu());
  rig.now_us += 1'100'000;
  rig.sample<host::Imu14>(300, -1, 60);
  EXPECT_TRUE(rig.sensors.take_imu());
  EXPECT_EQ(rig.sample<host::Imu14>(400, -1, 60), 1);
}

TEST(CanSensors, FieldAndAirComeInTheirUnitsAndWhatCannotBeDoesNot) {
  SensorRig rig;
  rig.hear(host::MagneticFieldStrength2{0, {0.25f, -0.5f, 0.125f}, {}}, 52);
  const auto field_uT = rig.sensors.take_field_uT();
  ASSERT_TRUE(field_uT);
  EXPECT_EQ(*field_uT, (std::array<float, 3>{25.0f, -50.0f, 12.5f}));
  rig.hear(host::MagneticFieldStrength2{0, {0.25f, std::nanf(""), 0.125f}, {}}, 52);
  EXPECT_FALSE(rig.sensors.take_field_uT());
  EXPECT_EQ(rig.sensors.field_bad(), 1u);
  rig.hear(host::StaticPressure{95'123.5f, 1.0f}, 51);
  EXPECT_EQ(rig.sensors.take_pressure_Pa(), 95'123.5f);
  rig.hear(host::StaticPressure{-1.0f, 1.0f}, 51);
  rig.hear(host::StaticPressure{std::nanf(""), 1.0f}, 51);
  EXPECT_FALSE(rig.sensors.take_pressure_Pa());
  EXPECT_EQ(rig.sensors.air_bad(), 2u);
  rig.hear(host::StaticTemperature{293.25f, 1.0f}, 51);
  EXPECT_TRUE(near(rig.sensors.temperature_degC(), 20.1, stated(1e-4, "float")));
}

TEST(CanSensors, AFixIsReadFieldByFieldOnBothHalvesOfTheWorld) {
  SensorRig rig;
  host::Fix2 fix;
  fix.longitude_1e8_deg = -17'912'345'678;
  fix.latitude_1e8_deg = 8'912'345'670;
  fix.height_ellipsoid_mm = -12'345;
  fix.height_sea_mm = 99;
  fix.v_WB_W_mps = {1.5f, -2.5f, 3.25f};
  fix.satellites = 11;
  fix.status = host::Fix2::fix_3d;
  for (const float v : {1.0f, 2.0f, 4.0f, 0.25f, 0.5f, 1.0f}) fix.covariance.add(v);
  rig.hear(fix, 53);
  const auto got = rig.sensors.take_fix();
  ASSERT_TRUE(got);
  EXPECT_EQ(got->longitude_e7_deg, -1'791'234'567);
  EXPECT_EQ(got->latitude_e7_deg, 891'234'567);
  EXPECT_EQ(got->height_mm, -12'345);
  EXPECT_EQ(got->v_W_mps, (std::array<float, 3>{1.5f, -2.5f, 3.25f}));
  EXPECT_EQ(got->place_m2, (std::array<float, 3>{1.0f, 2.0f, 4.0f}));
  EXPECT_EQ(got->speed_m2ps2, (std::array<float, 3>{0.25f, 0.5f, 1.0f}));
  EXPECT_EQ(got->satellites, 11);
  EXPECT_EQ(got->status, 3);
  EXPECT_EQ(got->begun_us, rig.now_us);
  fix.covariance.size = 0;  // how good it is, is not told
  rig.hear(fix, 53);
  EXPECT_FALSE(rig.sensors.take_fix());
  EXPECT_EQ(rig.sensors.fix_bad(), 1u);
}

TEST(CanSensors, AVoltageHoldsForASecond) {
  SensorRig rig;
  EXPECT_FALSE(rig.sensors.voltage_V(rig.now_us));
  host::BatteryInfo info;
  info.voltage_V = 15.5f;
  rig.hear(info, 54);
  EXPECT_EQ(rig.sensors.voltage_V(rig.now_us + 900'000), 15.5f);
  EXPECT_FALSE(rig.sensors.voltage_V(rig.now_us + 1'100'000));
}

TEST(CanSensors, TypesAreTheHosts) {
  const auto same = [](const dronecan::Type& ours, const host::DataType& theirs) {
    return ours.id == theirs.id && ours.signature == theirs.signature;
  };
  EXPECT_TRUE(same(dronecan::kImu14, host::Imu14::kType));
  EXPECT_TRUE(same(dronecan::kImu16, host::Imu16::kType));
  EXPECT_TRUE(same(dronecan::kMagneticField2, host::MagneticFieldStrength2::kType));
  EXPECT_TRUE(same(dronecan::kStaticPressure, host::StaticPressure::kType));
  EXPECT_TRUE(same(dronecan::kStaticTemperature, host::StaticTemperature::kType));
  EXPECT_TRUE(same(dronecan::kFix2, host::Fix2::kType));
  EXPECT_TRUE(same(dronecan::kBatteryInfo, host::BatteryInfo::kType));
}

}  // namespace
}  // namespace fw
