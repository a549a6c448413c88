// Reports of timing images: what is read, and what is refused with its line.
#include "harness/timing/report.hpp"

#include <gtest/gtest.h>

namespace whirl::timing {
namespace {

constexpr const char* kGood =
    "timing 1 stm32f405\nrow add_16 128 128\nrow udiv_small 64 384\nend 2\n";

std::string complaint(const std::string& text) {
  const auto reports = read_reports(text, "board.txt");
  return reports ? "" : reports.error().message();
}

TEST(TimingReport, RowsCarryIterationsAndCycles) {
  const auto reports = read_reports(kGood, "board.txt");
  ASSERT_TRUE(reports.ok()) << reports.error().message();
  ASSERT_EQ(reports.value().size(), 1u);
  const Report& report = reports.value()[0];
  EXPECT_EQ(report.part, "stm32f405");
  EXPECT_TRUE(report.complete);
  ASSERT_EQ(report.rows.size(), 2u);
  EXPECT_EQ(report.rows[1].kernel, "udiv_small");
  EXPECT_EQ(report.rows[1].iterations, 64u);
  EXPECT_EQ(report.rows[1].cycles_per_iteration(), 6.0);
}

TEST(TimingReport, ATerminalsLineEndsAndItsOwnWordsAroundAreNoMatter) {
  const auto reports = read_reports(
      "Connected to /dev/ttyUSB0\r\n\xFF\x80\r\n\r\ntiming 1 stm32f103\r\nrow add_16 128 130\r\n"
      "\r\nend 1\r\nbye\r\n",
      "board.txt");
  ASSERT_TRUE(reports.ok()) << reports.error().message();
  EXPECT_TRUE(reports.value()[0].complete);
  EXPECT_EQ(reports.value()[0].rows[0].cycles, 130u);
}

TEST(TimingReport, OneFileMayHoldBothParts) {
  const auto reports =
      read_reports(std::string(kGood) + "timing 1 stm32f103\nrow add_16 1 1\nend 1\n", "board.txt");
  ASSERT_TRUE(reports.ok()) << reports.error().message();
  ASSERT_EQ(reports.value().size(), 2u);
  EXPECT_EQ(reports.value()[1].part, "stm32f103");
  EXPECT_EQ(reports.value()[1].rows.size(), 1u);
}

TEST(TimingReport, WithoutItsLastLineOrWithOneTooFewItIsNotComplete) {
  for (const char* text : {"timing 1 stm32f405\nrow add_16 128 128\n",
                           "timing 1 stm32f405\nrow add_16 128 128\nend 2\n",
                           "timing 1 stm32f405\nrow add_16 128 128\nend many\n"}) {
    const auto reports = read_reports(text, "board.txt");
    ASSERT_TRUE(reports.ok()) << text;
    EXPECT_FALSE(reports.value()[0].complete) << text;
    EXPECT_EQ(reports.value()[0].rows.size(), 1u);
  }
}

TEST(TimingReport, GarbageInsideIsRefusedWithItsLine) {
  const std::string begin = "timing 1 stm32f405\nrow add_16 128 128\n";
  for (const char* bad : {"rxw add_32 128 128", "row add_32 128", "row add_32 128 128 7",
                          "row add_32 -1 128", "row add_32 128 4294967296", "row add_32 128 1.5",
                          "row add_32 0x10 128", "\xFF\xFE", "end 1 2", "row add_32 0 0"}) {
    EXPECT_EQ(complaint(begin + bad + "\nend 2\n").find("board.txt:3: "), 0u)
        << bad << ": " << complaint(begin + bad + "\nend 2\n");
  }
}

TEST(TimingReport, ANameThatComesTwiceIsRefused) {
  EXPECT_NE(complaint("timing 1 stm32f405\nrow a 1 1\nrow a 1 2\nend 2\n").find("'a' comes twice"),
            std::string::npos);
}

TEST(TimingReport, AnotherVersionAndNoReportAtAllAreRefused) {
  EXPECT_NE(complaint("timing 2 stm32f405\nend 0\n").find("unknown version"), std::string::npos);
  EXPECT_NE(complaint("").find("holds no report"), std::string::npos);
  EXPECT_NE(complaint("row add_16 128 128\nend 1\n").find("holds no report"), std::string::npos);
}

}  // namespace
}  // namespace whirl::timing
