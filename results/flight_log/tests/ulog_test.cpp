// The ULog reader on a file that was typed by hand, from the format's description.
#include "results/flight_log/ulog.hpp"

#include <gtest/gtest.h>

#include <string>

namespace whirl::results {
namespace {

// Start 1000 us; flags; format imu:uint64_t timestamp;float x; sys_name HIL; imu as number 0; 1.5 at
// 2000 us. PX4's ulog_cpp reads it without an error.
constexpr const char* kGolden =
    "554c6f6701123501e803000000000000"
    "28004200000000000000000000000000"
    "00000000000000000000000000000000"
    "00000000000000000000001f0046696d"
    "753a75696e7436345f742074696d6573"
    "74616d703b666c6f617420783b140049"
    "10636861725b335d207379735f6e616d"
    "6548494c060041000000696d750e0044"
    "0000d0070000000000000000c03f";

std::vector<std::uint8_t> bytes_of(const std::string& hex) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

TEST(ULog, ReadsTheFileThatWasMadeByHand) {
  const ULog log = read_ulog(bytes_of(kGolden));
  EXPECT_EQ(log.damage, "");
  EXPECT_TRUE(log.closed);
  EXPECT_EQ(log.records_bytes, 142u);
  EXPECT_EQ(log.start_us, 1000u);
  EXPECT_EQ(log.infos.at("sys_name"), "HIL");
  EXPECT_EQ(log.topics.at("imu").time_us, std::vector<std::uint64_t>{2000});
  EXPECT_EQ(log.topics.at("imu").columns.at("x"), std::vector<double>{1.5});
}

TEST(ULog, ZerosBehindTheLastMessageAreAFileThatWasNotClosed) {
  auto bytes = bytes_of(kGolden);
  bytes.resize(bytes.size() + 5000);
  const ULog log = read_ulog(bytes);
  EXPECT_EQ(log.damage, "");
  EXPECT_FALSE(log.closed);
  EXPECT_EQ(log.records_bytes, 142u);
}

TEST(ULog, AMessageThatIsCutShortEndsTheLogBeforeIt) {
  auto bytes = bytes_of(kGolden);
  bytes.resize(bytes.size() - 1);
  const ULog log = read_ulog(bytes);
  EXPECT_FALSE(log.closed);
  EXPECT_EQ(log.samples(), 0u);
  EXPECT_EQ(log.infos.size(), 1u);
}

TEST(ULog, DropoutsStandAfterTheSampleBeforeThem) {
  auto bytes = bytes_of(kGolden + std::string("02004f2c01"));
  const ULog log = read_ulog(bytes);
  ASSERT_EQ(log.dropouts.size(), 1u);
  EXPECT_EQ(log.dropouts[0].duration_ms, 300u);
  EXPECT_EQ(log.dropouts[0].after_us, 2000u);
}

TEST(ULog, DataOfAWrongLengthOrOfNobodyIsDamage) {
  EXPECT_NE(read_ulog(bytes_of(kGolden + std::string("0300440000ff"))).damage, "");
  EXPECT_NE(read_ulog(bytes_of(kGolden + std::string("0e00440100d0070000000000000000c03f"))).damage,
            "");
}

TEST(ULog, WhatIsNoULogIsDamageFromItsFirstByte) {
  auto bytes = bytes_of(kGolden);
  bytes[0] = 0;
  EXPECT_NE(read_ulog(bytes).damage, "");
  EXPECT_EQ(read_ulog(bytes).records_bytes, 0u);
}

TEST(ULog, FieldsOfOtherFormatsAndListsBecomeColumns) {
  auto bytes = bytes_of("554c6f6701123501e803000000000000");
  const auto add = [&bytes](char type, const std::string& text) {
    bytes.push_back(static_cast<std::uint8_t>(text.size()));
    bytes.push_back(0);
    bytes.push_back(static_cast<std::uint8_t>(type));
    bytes.insert(bytes.end(), text.begin(), text.end());
  };
  using namespace std::string_literals;
  add('F', "e:uint8_t a;int16_t[2] b;");
  add('F', "s:uint64_t timestamp;e[2] esc;");
  add('A', "\0\x07\0s"s);
  add('D',
      "\x07\0"
      "\x10\0\0\0\0\0\0\0"
      "\x01"
      "\x02\0"
      "\xff\xff"
      "\x04"
      "\x05\0"
      "\x06\0"s);
  const ULog log = read_ulog(bytes);
  EXPECT_EQ(log.damage, "");
  const auto& columns = log.topics.at("s").columns;
  EXPECT_EQ(columns.at("esc[0].b[1]"), std::vector<double>{-1.0});
  EXPECT_EQ(columns.at("esc[1].a"), std::vector<double>{4.0});
  EXPECT_EQ(columns.at("esc[1].b[0]"), std::vector<double>{5.0});
}

}  // namespace
}  // namespace whirl::results
