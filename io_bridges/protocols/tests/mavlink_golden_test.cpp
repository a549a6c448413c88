// Golden frames by other hands: made with node-mavlink 2.3.0 (mavlink-mappings 1.0.22), sysid 1,
// compid 1, seq counting up from 0 in this order. Our bytes must equal them, and what we read from
// them must give the same bytes again.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io_bridges/protocols/mavlink_messages.hpp"

namespace whirl::io {
namespace {

std::string hex(const std::vector<std::uint8_t>& bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    constexpr char kDigits[] = "0123456789ABCDEF";
    if (!text.empty()) text += ' ';
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

template <typename Message>
void expect_golden(const Message& message, std::uint8_t seq, const std::string& golden) {
  MavlinkSender sender{1, 1, seq};
  const auto ours = encode(pack(message, sender));
  EXPECT_EQ(hex(ours), golden);
  int read = 0;
  MavlinkParser parser([&](const MavlinkFrame& frame, std::span<const std::uint8_t>) {
    const auto again = unpack<Message>(frame);
    ASSERT_TRUE(again);
    MavlinkSender same{1, 1, seq};
    EXPECT_EQ(hex(encode(pack(*again, same))), golden);
    ++read;
  });
  for (const std::uint8_t byte : ours) parser.add(byte);
  EXPECT_EQ(read, 1);
}

TEST(MavlinkGolden, SysStatus) {
  SysStatus m;
  m.sensors_present = 1;
  m.sensors_health = 3;
  m.load = 123;
  m.voltage_battery = 16400;
  m.current_battery = -77;
  m.drop_rate_comm = 7;
  m.errors_count = {1, 2, 3, 4};
  m.battery_remaining = 55;
  expect_golden(
      m, 0,
      "FD 1F 00 00 00 01 01 01 00 00 01 00 00 00 00 00 00 00 03 00 00 00 7B 00 10 40 B3 FF 07 00 "
      "00 00 01 00 02 00 03 00 04 00 37 47 ED");
}

TEST(MavlinkGolden, AttitudeQuaternion) {
  AttitudeQuaternion m;
  m.time_boot_ms = 9;
  m.q1 = 0.5f;
  m.q2 = 0.25f;
  m.q3 = 0.125f;
  m.q4 = 0.0625f;
  m.yawspeed = 3.0f;
  expect_golden(
      m, 1,
      "FD 20 00 00 01 01 01 1F 00 00 09 00 00 00 00 00 00 3F 00 00 80 3E 00 00 00 3E 00 00 80 3D "
      "00 00 00 00 00 00 00 00 00 00 40 40 53 14");
}

TEST(MavlinkGolden, LocalPositionNed) {
  LocalPositionNed m;
  m.x = 1.0f;
  m.y = 2.0f;
  m.z = -3.0f;
  m.vz = 4.0f;
  expect_golden(
      m, 2,
      "FD 1C 00 00 02 01 01 20 00 00 00 00 00 00 00 00 80 3F 00 00 00 40 00 00 40 C0 00 00 00 00 "
      "00 00 00 00 00 00 80 40 C5 19");
}

TEST(MavlinkGolden, CommandAck) {
  CommandAck m;
  m.command = 400;
  m.result = 4;
  m.result_param2 = -5;
  m.target_system = 255;
  expect_golden(m, 3, "FD 09 00 00 03 01 01 4D 00 00 90 01 04 00 FB FF FF FF FF 0C ED");
}

TEST(MavlinkGolden, SetPositionTargetLocalNed) {
  SetPositionTargetLocalNed m;
  m.x = 1.0f;
  m.afz = 2.0f;
  m.yaw = 0.5f;
  m.yaw_rate = 0.25f;
  m.type_mask = 0x09F8;
  m.target_system = 1;
  m.coordinate_frame = 1;
  expect_golden(
      m, 4,
      "FD 35 00 00 04 01 01 54 00 00 00 00 00 00 00 00 80 3F 00 00 00 00 00 00 00 00 00 00 00 00 "
      "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 40 00 00 00 3F 00 00 80 3E F8 09 "
      "01 00 01 B4 F9");
}

TEST(MavlinkGolden, ViconPositionEstimate) {
  ViconPositionEstimate m;
  m.usec = 123456789012;
  m.z = -1.5f;
  m.yaw = 0.75f;
  m.covariance[20] = 9.0f;
  expect_golden(
      m, 5,
      "FD 74 00 00 05 01 01 68 00 00 14 1A 99 BE 1C 00 00 00 00 00 00 00 00 00 00 00 00 00 C0 BF "
      "00 00 00 00 00 00 00 00 00 00 40 3F 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
      "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
      "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
      "00 00 00 00 10 41 A9 4A");
}

TEST(MavlinkGolden, HighresImu) {
  HighresImu m;
  m.time_usec = 77;
  m.zacc = -9.75f;
  m.temperature = 25.5f;
  m.fields_updated = 63;
  m.id = 2;
  expect_golden(
      m, 6,
      "FD 3F 00 00 06 01 01 69 00 00 4D 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 1C C1 "
      "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
      "00 00 00 00 00 00 00 00 CC 41 3F 00 02 54 2F");
}

TEST(MavlinkGolden, Statustext) {
  Statustext m;
  m.severity = 4;
  m.set_text("hello");
  m.id = 513;
  m.chunk_seq = 1;
  expect_golden(
      m, 7,
      "FD 36 00 00 07 01 01 FD 00 00 04 68 65 6C 6C 6F 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
      "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
      "00 01 02 01 FE F0");
}

TEST(MavlinkGolden, ParamRequestRead) {
  ParamRequestRead m;
  m.target_system = m.target_component = 1;
  m.param_id = to_param_id("EST_FILTER");
  expect_golden(m, 8,
                "FD 0E 00 00 08 01 01 14 00 00 FF FF 01 01 45 53 54 5F 46 49 4C 54 45 52 A6 A4");
}

TEST(MavlinkGolden, ParamRequestList) {
  ParamRequestList m;
  m.target_system = m.target_component = 1;
  expect_golden(m, 9, "FD 02 00 00 09 01 01 15 00 00 01 01 8A C8");
}

TEST(MavlinkGolden, ParamValue) {
  ParamValue m;
  m.param_value = 1.25f;
  m.param_count = 4;
  m.param_index = 1;
  m.param_id = to_param_id("EST_START_SCALE");
  expect_golden(m, 10,
                "FD 19 00 00 0A 01 01 16 00 00 00 00 A0 3F 04 00 01 00 45 53 54 5F 53 54 41 52 54 "
                "5F 53 43 41 4C 45 00 09 CB C9");
}

TEST(MavlinkGolden, ParamSet) {
  ParamSet m;
  m.param_value = -0.5f;
  m.target_system = m.target_component = 1;
  m.param_id = to_param_id("SIXTEEN_LETTERS_");
  EXPECT_EQ(param_name(m.param_id), "SIXTEEN_LETTERS_");
  expect_golden(m, 11,
                "FD 17 00 00 0B 01 01 17 00 00 00 00 00 BF 01 01 53 49 58 54 45 45 4E 5F 4C 45 54 "
                "54 45 52 53 5F 09 4B F9");
}

}  // namespace
}  // namespace whirl::io
