// Tables of expectations: their form, and that those in the tree say where each number is from.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <sstream>

#include "harness/timing/expectations.hpp"

namespace whirl::timing {
namespace {

std::string file(const std::string& name) {
  std::ifstream in(std::string(WHIRL_ROOT) + "/io_bridges/qemu/" + name);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(TimingTable, ARowHasItsRangeSourceAndDerivation) {
  const auto table = read_expectations(
      "# a comment\n\nsection Branches: P is 1 to 3\nrow b_taken 5 2 4.5  ARM+ST  1 + P,  W "
      "beside\n"
      "row open 0 - - ARM only reported\n",
      "t.txt");
  ASSERT_TRUE(table.ok()) << table.error().message();
  ASSERT_EQ(table.value().size(), 2u);
  const Expectation& e = table.value()[0];
  EXPECT_EQ(e.section, "Branches: P is 1 to 3");
  EXPECT_EQ(e.kernel, "b_taken");
  EXPECT_EQ(e.wait_states, 5u);
  EXPECT_TRUE(e.judged);
  EXPECT_EQ(e.low_cycles, 2.0);
  EXPECT_EQ(e.high_cycles, 4.5);
  EXPECT_EQ(e.source, "ARM+ST");
  EXPECT_EQ(e.derivation, "1 + P,  W beside");
  EXPECT_FALSE(table.value()[1].judged);
}

TEST(TimingTable, WhatIsWrongIsToldWithItsLine) {
  for (const char* bad :
       {"row a 0 2 1 ARM low above high", "row a 0 0 1 ARM zero", "row a 0 -1 1 ARM negative",
        "row a 0 nan 1 ARM no number", "row a 0 1 inf ARM no end", "row a 0 - 1 ARM half open",
        "row a x 1 1 ARM wait states", "row a 99 1 1 ARM wait states", "row a 0 1 1 ARM",
        "line a 0 1 1 ARM another word", "row first 0 1 1 ARM comes twice"}) {
    const auto table = read_expectations("row first 0 1 1 ARM one\n" + std::string(bad), "t.txt");
    ASSERT_FALSE(table.ok()) << bad;
    EXPECT_EQ(table.error().message().find("t.txt:2: "), 0u) << table.error().message();
  }
  EXPECT_FALSE(read_expectations("# nothing\n", "t.txt").ok());
}

TEST(TimingTable, EveryKeyInTheTreeIsResolved) {
  const std::string references = file("REFERENCES.md");
  for (const char* part : {"stm32f405", "stm32f103"}) {
    const auto table = read_expectations(file(std::string("data/timing_") + part + ".txt"), part);
    ASSERT_TRUE(table.ok()) << table.error().message();
    EXPECT_GT(table.value().size(), 100u);
    for (const Expectation& e : table.value()) {
      EXPECT_FALSE(e.section.empty()) << e.kernel;
      std::istringstream keys(e.source);
      for (std::string key; std::getline(keys, key, '+');) {
        EXPECT_NE(references.find("\n- [" + key + "] "), std::string::npos) << e.kernel << key;
      }
    }
  }
}

}  // namespace
}  // namespace whirl::timing
