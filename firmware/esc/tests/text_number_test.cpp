// Numbers as text against the C library's own conversions.
#include "firmware/esc/image/text_number.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace fw::esc {
namespace {

std::string written(float value) {
  NumberText text;
  return std::string(write_number(value, text));
}
float parsed(const std::string& text) {
  float value = std::nanf("");
  EXPECT_TRUE(parse_number(text, value)) << text;
  return value;
}

TEST(TextNumber, EveryFloatComesBackAsTheSameBits) {
  std::uint32_t seen = 0;
  for (std::uint64_t bits = 0x0080'0000; bits < 0x7F80'0000;
       bits += 2503) {  // a prime: all mantissas
    const float value = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    const std::string text = written(value);
    ASSERT_EQ(parsed(text), value) << text;
    ASSERT_EQ(std::strtof(text.c_str(), nullptr), value) << text;  // nor is the text another number
    ASSERT_EQ(parsed(written(-value)), -value);
    ++seen;
  }
  EXPECT_GT(seen, 800'000u);
}

TEST(TextNumber, WritesNineDigits) {
  EXPECT_EQ(written(0.01005f), "1.00499997e-2");
  EXPECT_EQ(written(1.0f), "1.00000000e0");
  EXPECT_EQ(written(-16.25f), "-1.62500000e1");
  EXPECT_EQ(written(999999936.0f), "9.99999936e8");
  EXPECT_EQ(written(0.0f), "0");
  EXPECT_EQ(written(std::nanf("")), "nan");
  EXPECT_EQ(written(-INFINITY), "-inf");
}

TEST(TextNumber, ReadsWhatPeopleWriteAsTheNearestFloat) {
  for (const char* text : {"3.25", "-1.2e-7", "0.16", "1.789e-7", "20", ".5", "5.", "1e+3", "0",
                           "3.4028234e38", "0.00000000000000000000000001", "16777217.0000000000001",
                           "123456789012345678901234567890"}) {
    EXPECT_EQ(parsed(text), std::strtof(text, nullptr)) << text;
  }
}

TEST(TextNumber, WhatIsNoNumberIsRefused) {
  for (const char* text : {"", "-", ".", "e5", "1e", "1e-", "1e1.5", "1.2.3", "12a", "--1", "1e39",
                           "1e99", "1e12345", "nan", "inf", " 1"}) {
    float value = 7.0f;
    EXPECT_FALSE(parse_number(text, value)) << text;
    EXPECT_EQ(value, 7.0f) << text;
  }
}

}  // namespace
}  // namespace fw::esc
