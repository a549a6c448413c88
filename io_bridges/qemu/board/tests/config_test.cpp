// Numbers of a board's JSON: what is read, what is refused.
#include "io_bridges/qemu/board/config.hpp"

#include <gtest/gtest.h>

namespace whirl::board {
namespace {

Result<BoardConfig> parse(const std::string& pairs) {
  return parse_board(R"({"board":"b","image":"x",)" + pairs + "}");
}

TEST(BoardConfig, WholeNumbersAreReadToTheEndOfTheirRange) {
  const auto config = parse(R"("seed":18446744073709551615,"start":4294967295,"sync_ns":2e6)");
  ASSERT_TRUE(config);
  EXPECT_EQ(config.value().seed, 18446744073709551615u);
  EXPECT_EQ(config.value().start, 4294967295u);
  EXPECT_EQ(config.value().sync_ns, 2'000'000);
}

TEST(BoardConfig, ANumberThatDoesNotFitIsRefusedByItsKey) {
  for (const char* pair :
       {R"("seed":4777770000000001638205164046)", R"("seed":-1)", R"("start":4294967296)",
        R"("gdb_port":2147483648)", R"("gdb_port":1.5)", R"("sync_ns":1e300)",
        R"("sync_ns":-1e300)", R"("gdb_port":true)", R"("gdb_port":"1")"}) {
    const auto config = parse(pair);
    ASSERT_FALSE(config) << pair;
    const std::string key = std::string(pair).substr(1, std::string(pair).find(':') - 2);
    EXPECT_NE(config.error().message().find("b: " + key + ": is not a whole number"),
              std::string::npos)
        << config.error().message();
  }
}

TEST(BoardConfig, ACrystalCannotStartBeforeItIsAsked) {
  EXPECT_FALSE(parse(R"("hse_start_ns":-1)"));
  EXPECT_TRUE(parse(R"("hse_start_ns":0)"));
}

TEST(BoardConfig, AnOscillatorsErrorIsWithinItsRangeAndOfOneThatIsThere) {
  for (const char* good : {R"("hsi_error":-0.05)", R"("hse_Hz":8e6,"hse_error":0.001)",
                           R"("hse_Hz":8e6,"hse_error":-0.001,"hsi_error":0.05)"}) {
    EXPECT_TRUE(parse(good)) << good;
  }
  EXPECT_EQ(parse(R"("hsi_error":0.01)").value().hsi_error, 0.01);
  for (const char* bad :
       {R"("hsi_error":0.0501)", R"("hsi_error":-0.0501)", R"("hse_Hz":8e6,"hse_error":0.00101)",
        R"("hse_Hz":8e6,"hse_error":-0.00101)", R"("hse_error":0.0001)", R"("hsi_error":"1 %")"}) {
    const auto config = parse(bad);
    ASSERT_FALSE(config) << bad;
    EXPECT_NE(config.error().message().find("_error"), std::string::npos) << bad;
  }
}

}  // namespace
}  // namespace whirl::board
