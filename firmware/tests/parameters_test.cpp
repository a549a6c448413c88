#include "firmware/config/parameters.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "firmware/config/parameter_record.hpp"

namespace fw {
namespace {

constexpr auto kScale = static_cast<std::size_t>(Parameter::est_start_scale);
constexpr auto kFilter = static_cast<std::size_t>(Parameter::est_filter);
constexpr auto kForward = static_cast<std::size_t>(Parameter::ctl_feedforward);

TEST(Parameters, StartAsTheTableSaysAndAreFoundByTheirNames) {
  const Parameters parameters;
  for (std::size_t i = 0; i < kParameterCount; ++i) {
    EXPECT_EQ(parameters.value(i), kParameterTable[i].start) << i;
    EXPECT_EQ(Parameters::index_of(kParameterTable[i].name), i);
  }
  EXPECT_EQ(parameters.changes(), 0u);
  EXPECT_FALSE(Parameters::index_of("EST_FILTE"));
  EXPECT_FALSE(Parameters::index_of("EST_FILTER2"));
  EXPECT_FALSE(Parameters::index_of(""));
}

TEST(Parameters, TakeBothBoundsAndNothingBeyond) {
  for (std::size_t i = 0; i < kParameterCount; ++i) {
    const ParameterRow& row = kParameterTable[i];
    Parameters parameters;
    EXPECT_TRUE(parameters.set(i, row.low, false)) << row.name;
    EXPECT_EQ(parameters.value(i), row.low);
    EXPECT_TRUE(parameters.set(i, row.high, false)) << row.name;
    const float inf = std::numeric_limits<float>::infinity();
    for (const float bad :
         {std::nextafter(row.low, -inf), std::nextafter(row.high, inf), inf, -inf, std::nanf("")}) {
      EXPECT_FALSE(parameters.set(i, bad, false)) << row.name << ' ' << bad;
      EXPECT_EQ(parameters.value(i), row.high) << row.name << ' ' << bad;
    }
  }
}

TEST(Parameters, WholeOnesTakeNoFraction) {
  Parameters parameters;
  EXPECT_FALSE(parameters.set(kFilter, 0.5f, false));
  EXPECT_TRUE(parameters.set(kScale, 0.75f, false));
  EXPECT_EQ(parameters.get(Parameter::est_start_scale), 0.75f);
  EXPECT_TRUE(parameters.is_on(Parameter::est_filter));
  EXPECT_TRUE(parameters.is_on(Parameter::ctl_feedforward));
}

TEST(Parameters, WhileArmedOnlyTheRowsThatMay) {
  Parameters parameters;
  EXPECT_FALSE(parameters.set(kFilter, 0.0f, true));
  EXPECT_EQ(parameters.value(kFilter), 1.0f);
  EXPECT_TRUE(parameters.set(kFilter, 1.0f, true));  // what it is already
  EXPECT_TRUE(parameters.set(kForward, 0.0f, true));
}

TEST(Parameters, OnlyAChangeCounts) {
  Parameters parameters;
  parameters.set(kScale, 1.0f, false);
  parameters.set(kScale, 9.0f, false);
  parameters.set(kParameterCount, 1.0f, false);
  EXPECT_EQ(parameters.changes(), 0u);
  parameters.set(kScale, 1.5f, false);
  EXPECT_EQ(parameters.changes(), 1u);
}

// Both CRCs by another hand: Python's zlib.crc32 of the name, and of the words little-endian.
TEST(ParameterRecord, HoldsWhatDiffersFromTheTable) {
  Parameters parameters;
  parameters.set(kScale, 1.25f, false);
  const ParameterRecord record(parameters, 7, 3);
  const auto words = record.words();
  ASSERT_EQ(words.size(), 6u);
  EXPECT_EQ(words[0], 0x5041'0001u);
  EXPECT_EQ(words[1], 7u);
  EXPECT_EQ(words[2], 3u);
  EXPECT_EQ(words[3], 0x8A22'A98Au);
  EXPECT_EQ(words[4], 0x3FA0'0000u);
  EXPECT_EQ(words[5], 0x4686'2233u);
}

TEST(ParameterRecord, WhatNoRowKnowsOrBoundsRefuseChangesNothing) {
  Parameters parameters;
  restore(parameters, 0x12345678u, 0x3F80'0000u);
  restore(parameters, crc32_of("EST_START_SCALE"), 0x4110'0000u);  // 9
  EXPECT_EQ(parameters.changes(), 0u);
}

}  // namespace
}  // namespace fw
