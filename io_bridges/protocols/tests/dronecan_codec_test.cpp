// Bits, halves, signatures, and what decoding refuses.
#include <gtest/gtest.h>

#include <limits>

#include "base/near.hpp"
#include "base/random.hpp"
#include "io_bridges/protocols/dronecan/esc.hpp"
#include "io_bridges/protocols/dronecan/gnss.hpp"
#include "io_bridges/protocols/dronecan/imu_samples.hpp"
#include "io_bridges/protocols/dronecan/node.hpp"
#include "io_bridges/protocols/dronecan/param.hpp"
#include "io_bridges/protocols/dronecan/sensors.hpp"
#include "io_bridges/protocols/dronecan/vehicle_state.hpp"

namespace whirl::io::dronecan {
namespace {

TEST(DronecanFloat16, EveryPatternComesBack) {
  for (std::uint32_t half = 0; half < 0x10000; ++half) {
    const float value = from_float16(static_cast<std::uint16_t>(half));
    const std::uint16_t again = to_float16(value);
    if (std::isnan(value)) {
      EXPECT_TRUE((again & 0x7C00) == 0x7C00 && (again & 0x3FF) != 0) << half;
    } else {
      EXPECT_EQ(again, half);
    }
  }
}

TEST(DronecanFloat16, RoundsToTheNearestAndTiesToEven) {
  EXPECT_EQ(to_float16(1.0f), 0x3C00);
  EXPECT_EQ(to_float16(1.0f + 0x1p-11f), 0x3C00);             // half way: the even one
  EXPECT_EQ(to_float16(1.0f + 0x1p-11f + 0x1p-20f), 0x3C01);  // a little more
  EXPECT_EQ(to_float16(1.0f + 3 * 0x1p-11f), 0x3C02);
  EXPECT_EQ(to_float16(0x1p-24f), 0x0001);
  EXPECT_EQ(to_float16(0x1p-25f), 0x0000);
  EXPECT_EQ(to_float16(0x1.8p-24f), 0x0002);
}

TEST(DronecanFloat16, SaturatesWhatIsFiniteOnly) {
  EXPECT_EQ(to_float16(65504.0f), 0x7BFF);
  EXPECT_EQ(to_float16(1e9f), 0x7BFF);
  EXPECT_EQ(to_float16(-1e9f), 0xFBFF);
  EXPECT_EQ(to_float16(-std::numeric_limits<float>::infinity()), 0xFC00);
}

TEST(DronecanBits, AnyFieldsInAnyOrderComeBack) {
  RandomStream random(1, "bits");
  for (int round = 0; round < 300; ++round) {
    std::vector<std::pair<std::uint64_t, int>> fields;
    Payload payload;
    BitWriter writer(payload);
    for (int n = 0; n < 40; ++n) {
      const int width = static_cast<int>(random.bits() % 65);
      const std::uint64_t bits = static_cast<std::uint64_t>(random.bits()) << 32 | random.bits();
      fields.emplace_back(width == 0 ? 0 : bits >> (64 - width), width);
      writer.bits(fields.back().first, width);
    }
    writer.close();
    BitReader reader(payload.bytes());
    for (const auto& [value, width] : fields) ASSERT_EQ(reader.bits(width), value) << width;
    EXPECT_TRUE(reader.ok());
    EXPECT_LT(reader.left(), 8u);
  }
}

TEST(DronecanSignature, OfPublishedTypesFollowsFromTheirText) {
  EXPECT_EQ(signature_of("123456789"), 0x62EC59E3F1A4F00A);  // the catalogue's check value
  EXPECT_EQ(signature_of("uavcan.equipment.esc.RawCommand\nsaturated int14[<=20] cmd"),
            RawCommand::kType.signature);
  EXPECT_EQ(signature_of("uavcan.equipment.air_data.StaticPressure\nsaturated float32 "
                         "static_pressure\nsaturated float16 static_pressure_variance"),
            StaticPressure::kType.signature);
}

TEST(DronecanDecode, RefusesWhatIsTooShortOrAByteTooLong) {
  const Payload whole = encode(EscStatus{.speed_rpm = 100});
  EXPECT_TRUE(decode<EscStatus>(whole.bytes()));
  for (std::size_t n = 0; n < whole.size; ++n) {
    EXPECT_FALSE(decode<EscStatus>(whole.bytes().first(n))) << n;
  }
  EXPECT_FALSE(decode<EscStatus>(std::span(whole.data).first(whole.size + 1)));
}

TEST(DronecanDecode, RefusesMoreThanAnArrayHolds) {
  const std::vector<std::uint8_t> bytes(36);
  EXPECT_TRUE(decode<RawCommand>(std::span(bytes).first(35)));
  EXPECT_FALSE(decode<RawCommand>(std::span(bytes).first(37)));
}

TEST(DronecanDecode, RefusesATagThatNoUnionHas) {
  const std::uint8_t tag_5[] = {0x00, 0x05};
  const std::uint8_t tag_7[] = {0x00, 0x07};
  EXPECT_FALSE(decode<GetSetRequest>(tag_5));
  EXPECT_FALSE(decode<GetSetRequest>(tag_7));
}

TEST(DronecanEncode, IntegersBeyondTheirWidthAreClamped) {
  RawCommand command;
  command.commands.add(20'000);
  command.commands.add(-20'000);
  const auto again = decode<RawCommand>(encode(command).bytes());
  EXPECT_EQ(again->commands.items[0], 8191);
  EXPECT_EQ(again->commands.items[1], -8192);
  EXPECT_EQ(decode<ArmingStatus>(encode(ArmingStatus{7}).bytes())->status, 7);
}

// The largest payload of each type is what its DSDL says (bytes, tail arrays without their lengths).
TEST(DronecanEncode, TheLargestOfEachTypeIsAsLongAsItsDefinitionSays) {
  RawImu imu;
  imu.covariance.size = 36;
  EXPECT_EQ(encode(imu).size, RawImu::kType.most_bytes);
  Fix2 fix;
  fix.covariance.size = fix.ecef.covariance.size = 36;
  fix.ecef_count = 1;
  EXPECT_EQ(encode(fix).size, Fix2::kType.most_bytes);
  GetNodeInfoResponse info;
  info.certificate.size = 255;
  info.name.size = 80;
  EXPECT_EQ(encode(info).size, GetNodeInfoResponse::kType.most_bytes);
  GetSetResponse response;
  response.value.tag = response.default_value.tag = ParamValue::text;
  response.value.as_text.size = response.default_value.as_text.size = 128;
  response.most.tag = response.least.tag = ParamValue::integer;
  response.name.size = 92;
  EXPECT_EQ(encode(response).size, GetSetResponse::kType.most_bytes);
  BatteryInfo battery;
  battery.model_name.size = 31;
  EXPECT_EQ(encode(battery).size, BatteryInfo::kType.most_bytes);
  RawCommand raw;
  raw.commands.size = kMost_escs;
  EXPECT_EQ(encode(raw).size, RawCommand::kType.most_bytes);
  RpmCommand rpm;
  rpm.speeds_rpm.size = kMost_escs;
  EXPECT_EQ(encode(rpm).size, RpmCommand::kType.most_bytes);
}

TEST(DronecanFix2, CarriesAnEcefPositionOrNone) {
  Fix2 fix;
  fix.covariance.size = 6;
  fix.ecef_count = 1;
  fix.ecef.position_mm = {4'278'990'123, -642'000'000, 4'670'000'001};
  const auto with = decode<Fix2>(encode(fix).bytes());
  EXPECT_EQ(with->ecef_count, 1);
  EXPECT_EQ(with->ecef.position_mm, fix.ecef.position_mm);
  EXPECT_EQ(with->covariance.size, 6u);
  fix.ecef_count = 0;
  EXPECT_EQ(decode<Fix2>(encode(fix).bytes())->ecef_count, 0);
}

TEST(ImuSamples, AreTwoAndThreeFramesAndKeepTheirSteps) {
  Imu14 fine;
  fine.rate = {to_steps<Imu14>(kImu_rate_full_radps, Imu14::kRate_step_radps),
               to_steps<Imu14>(-100.0, Imu14::kRate_step_radps), -1};
  fine.acceleration[2] = to_steps<Imu14>(-9.80665, Imu14::kAcceleration_step_mps2);
  fine.time = 0x1FFF;  // modulo 4096
  EXPECT_EQ(encode(fine).size, 12u);
  const auto got = decode<Imu14>(encode(fine).bytes());
  EXPECT_EQ(got->rate, (std::array<std::int16_t, 3>{8191, -8192, -1}));
  EXPECT_EQ(got->acceleration[2], -512);
  EXPECT_EQ(got->time, 0xFFF);
  EXPECT_EQ(encode(Imu16{}).size, 14u);
  EXPECT_EQ(to_steps<Imu16>(std::nan(""), 1.0), 0);
}

}  // namespace
}  // namespace whirl::io::dronecan
