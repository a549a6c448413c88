// whirl validate --timing FILE: a board's own lines against a table, by exit code and by name.
#include <gtest/gtest.h>

#include "harness/tests/fake.hpp"

namespace whirl::test {
namespace {

class TimingCommand : public ::testing::Test {
 protected:
  TimingCommand() {
    root_.write("io_bridges/qemu/data/timing_stm32f405.txt",
                "section Data processing\nrow add_16 0 1 1 ARM one\n"
                "section Branches\nrow b_taken 0 2 4 ARM 1 + P\nrow empty 0 - - ARM nothing\n");
  }
  Outcome judged(const std::string& rows, const std::string& part = "stm32f405") const {
    root_.write("board.txt", "timing 1 " + part + "\n" + rows);
    return whirl(root_, {"validate", "--timing", root_.path() + "/board.txt"});
  }
  FakeRoot root_;
};

bool has(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

TEST_F(TimingCommand, AllWithinIsZero) {
  const Outcome o = judged("row add_16 128 128\nrow b_taken 32 96\nrow empty 1 0\nend 3\n");
  EXPECT_EQ(o.code, 0) << o.out << o.err;
  EXPECT_TRUE(has(o.out, "stm32f405: 2 of 2 within 10 %")) << o.out;
  EXPECT_TRUE(has(root_.read("results/validation/timing.html"), "b_taken")) << o.out;
}

TEST_F(TimingCommand, AWrongRowIsOne) {
  const Outcome o = judged("row add_16 128 256\nrow b_taken 32 96\nrow empty 1 0\nend 3\n");
  EXPECT_EQ(o.code, 1) << o.out << o.err;
  EXPECT_TRUE(has(o.out, "+100.0%  OFF")) << o.out;
  EXPECT_TRUE(has(o.out, "stm32f405: 1 of 2 within 10 %")) << o.out;
}

TEST_F(TimingCommand, TwelvePercentIsShownApartAndIsNoPass) {
  const Outcome o = judged("row add_16 100 112\nrow b_taken 32 96\nrow empty 1 0\nend 3\n");
  EXPECT_EQ(o.code, 1) << o.out << o.err;
  EXPECT_TRUE(has(o.out, "1 of 2 within 10 %, 1 more within 15 %")) << o.out;
}

TEST_F(TimingCommand, MissingAndUnknownKernelsAreNamed) {
  const Outcome o = judged("row add_16 128 128\nrow add_17 1 1\nrow empty 1 0\nend 3\n");
  EXPECT_EQ(o.code, 1) << o.out << o.err;
  EXPECT_TRUE(has(o.out, "\n  b_taken: NOT REPORTED")) << o.out;
  EXPECT_TRUE(has(o.out, "\n  add_17: NOT IN THE TABLE")) << o.out;
}

TEST_F(TimingCommand, AReportThatIsCutShortIsNoPassThoughAllRowsAreThere) {
  const Outcome o = judged("row add_16 128 128\nrow b_taken 32 96\nrow empty 1 0\n");
  EXPECT_EQ(o.code, 1) << o.out << o.err;
  EXPECT_TRUE(has(o.out, "cut short")) << o.out;
}

TEST_F(TimingCommand, GarbageAnUnknownPartAndNoFileAreTwo) {
  EXPECT_EQ(judged("row add_16 many 128\nend 1\n").code, 2);
  const Outcome part = judged("row add_16 1 1\nend 1\n", "stm32h743");
  EXPECT_EQ(part.code, 2);
  EXPECT_TRUE(has(part.err, "no table for a part 'stm32h743'")) << part.err;
  EXPECT_EQ(whirl(root_, {"validate", "--timing", root_.path() + "/gone.txt"}).code, 2);
  EXPECT_EQ(whirl(root_, {"validate", root_.path() + "/board.txt"}).code, 2);  // without --timing
}

}  // namespace
}  // namespace whirl::test
