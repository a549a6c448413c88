// DroneCAN messages against frames that another implementation made (pydronecan 08cda37a over DSDL b4653c7a), both
// ways; param.GetSet by hand from the DSDL.
#include <gtest/gtest.h>

#include <string>

#include "base/near.hpp"
#include "io_bridges/protocols/dronecan/allocation.hpp"
#include "io_bridges/protocols/dronecan/esc.hpp"
#include "io_bridges/protocols/dronecan/gnss.hpp"
#include "io_bridges/protocols/dronecan/param.hpp"
#include "io_bridges/protocols/dronecan/sensors.hpp"
#include "io_bridges/protocols/dronecan/types.hpp"
#include "io_bridges/protocols/dronecan/vehicle_state.hpp"

namespace whirl::io::dronecan {
namespace {

std::string hex(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

std::vector<std::uint8_t> from_hex(const std::string& text) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < text.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(text.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

// "e8..80 / 00..": the frames of a transfer, as the table of facts prints them.
std::string printed(const std::vector<CanFrame>& frames) {
  std::string text;
  for (const CanFrame& frame : frames) {
    text += (text.empty() ? "" : " / ") + hex(frame.bytes());
  }
  return text;
}

std::vector<CanFrame> parsed(std::uint32_t id, const std::string& text) {
  std::vector<CanFrame> frames;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(" / ", at), text.size());
    const auto bytes = from_hex(text.substr(at, end - at));
    CanFrame frame{.id = id, .extended = true, .length = static_cast<std::uint8_t>(bytes.size())};
    std::copy(bytes.begin(), bytes.end(), frame.data.begin());
    frames.push_back(frame);
    at = end + 3;
  }
  return frames;
}

// Out: the very frames. In: the message, which encodes to the same payload again.
template <typename Message>
std::optional<Message> expect_both_ways(const Message& message, std::uint8_t source,
                                        std::uint8_t transfer_id, std::uint8_t priority,
                                        std::uint32_t id, const std::string& frames) {
  const DataType& type = Message::kType;
  const Header header{
      .type_id = type.id, .priority = priority, .source = source, .transfer_id = transfer_id};
  const Payload payload = encode(message);
  const auto made = frames_of(header, type.signature, payload.bytes());
  EXPECT_EQ(printed(made), frames);
  EXPECT_EQ(made.front().id, id);

  Assembler assembler(known_type);
  const Transfer* transfer = nullptr;
  for (const CanFrame& frame : parsed(id, frames)) {
    EXPECT_EQ(transfer, nullptr);
    transfer = assembler.take(frame, 0);
  }
  if (transfer == nullptr) {
    ADD_FAILURE() << "no transfer";
    return std::nullopt;
  }
  EXPECT_EQ(transfer->header, header);
  const auto again = decode<Message>(transfer->payload);
  EXPECT_TRUE(again && hex(encode(*again).bytes()) == hex(transfer->payload));
  return again;
}

template <typename T, std::size_t N>
Bounded<T, N> list(std::initializer_list<T> items) {
  Bounded<T, N> values;
  for (const T& item : items) values.add(item);
  return values;
}

TEST(DronecanGolden, NodeStatus) {
  const NodeStatus status{.uptime_s = 0x01020304, .health = 1, .mode = 3, .vendor_code = 0xABCD};
  const auto got = expect_both_ways(status, 42, 5, 24, 0x1801552A, "0403020158cdabc5");
  EXPECT_EQ(got->uptime_s, 0x01020304u);
  EXPECT_EQ(got->health, 1);
  EXPECT_EQ(got->mode, 3);
  EXPECT_EQ(got->vendor_code, 0xABCD);
}

TEST(DronecanGolden, RawCommandOfFourEscsIsOneFrame) {
  const RawCommand up{list<std::int16_t, kMost_escs>({1000, 2000, 3000, 4000})};
  EXPECT_EQ(expect_both_ways(up, 10, 0, 8, 0x0804060A, "e80f407b82e80fc0")->commands, up.commands);
  const RawCommand ends{list<std::int16_t, kMost_escs>({8191, -8192, 1, -1})};
  EXPECT_EQ(expect_both_ways(ends, 10, 1, 8, 0x0804060A, "ff7c0200103fffc1")->commands,
            ends.commands);
}

TEST(DronecanGolden, RpmCommandOfFourEscsIsTwoFrames) {
  const RpmCommand speeds{list<std::int32_t, kMost_escs>({5000, 6000, -7000, 8000})};
  const auto got = expect_both_ways(speeds, 10, 2, 8, 0x0804070A, "a82688131c05ca82 / 8e4d007c62");
  EXPECT_EQ(got->speeds_rpm, speeds.speeds_rpm);
}

TEST(DronecanGolden, EscStatus) {
  const EscStatus status{.voltage_V = 16,
                         .current_A = 10,
                         .temperature_K = 300,
                         .speed_rpm = 5000,
                         .power_pct = 50,
                         .index = 2};
  const auto got = expect_both_ways(status, 20, 7, 16, 0x10040A14,
                                    "33a5000000000087 / 4c0049b05c881327 / 190847");
  EXPECT_EQ(got->voltage_V, 16);
  EXPECT_EQ(got->speed_rpm, 5000);
  EXPECT_EQ(got->power_pct, 50);
  EXPECT_EQ(got->index, 2);
}

TEST(DronecanGolden, ArmingStatus) {
  EXPECT_EQ(expect_both_ways(ArmingStatus{255}, 10, 3, 16, 0x10044C0A, "ffc3")->status, 255);
}

TEST(DronecanGolden, AirData) {
  const StaticPressure pressure{101325, 4};
  EXPECT_EQ(expect_both_ways(pressure, 30, 0, 16, 0x1004041E, "80e6c5470044c0")->pressure_Pa,
            101325);
  const StaticTemperature temperature{298.15f, 0};
  const auto got = expect_both_ways(temperature, 30, 0, 16, 0x1004051E, "a95c0000c0");
  EXPECT_TRUE(near(got->temperature_K, 298.15, counts(0.5, 0.25)));  // float16 from 256 to 512
}

TEST(DronecanGolden, MagneticFieldStrength2) {
  const MagneticFieldStrength2 field{.field_Ga = {0.2f, -0.05f, 0.4f}};
  const auto got = expect_both_ways(field, 30, 0, 16, 0x1003EA1E, "00663266aa6636c0");
  EXPECT_TRUE(near(got->field_Ga[1], -0.05, counts(0.5, 0x1p-15)));
}

TEST(DronecanGolden, RawImuIsSevenFrames) {
  const RawImu imu{.time_us = 1'000'000,
                   .rate_radps = {0.01f, -0.02f, 0.03f},
                   .acceleration_mps2 = {0, 0, -9.8125f}};
  const auto got = expect_both_ways(imu, 30, 0, 16, 0x1003EB1E,
                                    "b5d040420f000080 / 0000000000001f20 / 211fa5ae27000000 / "
                                    "0000000000000020 / 0000000000000000 / e8c8000000000020 / "
                                    "0000000000000040");
  EXPECT_EQ(got->time_us, 1'000'000u);
  EXPECT_EQ(got->acceleration_mps2[2], -9.8125f);
}

TEST(DronecanGolden, Fix2) {
  const Fix2 fix{.gnss_time_us = 1'700'000'000'000'000,
                 .time_standard = Fix2::utc,
                 .longitude_1e8_deg = 854'100'000,
                 .latitude_1e8_deg = 4'737'700'000,
                 .height_ellipsoid_mm = 500'000,
                 .height_sea_mm = 452'000,
                 .v_WB_W_mps = {1, 2, -0.5f},
                 .satellites = 12,
                 .status = Fix2::fix_3d,
                 .pdop = 1.5f};
  const auto got = expect_both_ways(fix, 40, 0, 16, 0x10042728,
                                    "d1f6000000000080 / 000000401e182420 / 0a06400000208800 / "
                                    "e83205048318d020 / 482841c507283000 / 0000803f00000020 / "
                                    "40000000bf330000 / 00003e60");
  EXPECT_EQ(got->latitude_1e8_deg, 4'737'700'000);
  EXPECT_EQ(got->height_sea_mm, 452'000);
  EXPECT_EQ(got->satellites, 12);
  EXPECT_EQ(got->ecef_count, 0);
}

TEST(DronecanGolden, TheFirstRequestForANodeId) {
  const Allocation request{.first_part = true,
                           .unique_id = list<std::uint8_t, 16>({1, 2, 3, 4, 5, 6})};
  EXPECT_EQ(hex(encode(request).bytes()), "01010203040506");
  const auto header = parse_can_id(0x1E214500);  // libcanard's discriminator
  ASSERT_TRUE(header);
  EXPECT_EQ(header->source, 0);
  EXPECT_EQ(header->type_id, 1);
  EXPECT_EQ(header->priority, 30);
}

TEST(DronecanGolden, GetSetRequestByHand) {
  GetSetRequest read;
  read.index = 5;
  read.name.add('a');
  EXPECT_EQ(hex(encode(read).bytes()), "050061");
  // Index 0x1234: 34, then 10010; the tag 001 of an integer; -2; "kv".
  const auto set = decode<GetSetRequest>(from_hex("3491feffffffffffffff6b76"));
  ASSERT_TRUE(set);
  EXPECT_EQ(set->index, 0x1234);
  EXPECT_EQ(set->value.as_integer, -2);
  EXPECT_EQ(set->name.size, 2u);
  EXPECT_EQ(hex(encode(*set).bytes()), "3491feffffffffffffff6b76");
}

TEST(DronecanGolden, GetSetResponseByHand) {
  // 00000 010 float 1.5; 00000 011 true; 000000 10 float 2; 000000 00 nothing; "g".
  const std::string bytes =
      "020000c03f0301020000004000"
      "67";
  const auto got = decode<GetSetResponse>(from_hex(bytes));
  ASSERT_TRUE(got);
  EXPECT_EQ(got->value.as_real, 1.5f);
  EXPECT_EQ(got->default_value.as_boolean, 1);
  EXPECT_EQ(got->most.as_real, 2.0f);
  EXPECT_EQ(got->least.tag, ParamValue::empty);
  EXPECT_EQ(got->name.items[0], 'g');
  EXPECT_EQ(hex(encode(*got).bytes()), bytes);
}

}  // namespace
}  // namespace whirl::io::dronecan
