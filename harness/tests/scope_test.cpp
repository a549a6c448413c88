// The live view of a bench, on pseudo-terminals: an instrument's line at one end, the view at another.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <limits>
#include <thread>

#include "base/output_file.hpp"
#include "base/scratch_folder.hpp"
#include "harness/cli/spark_line.hpp"
#include "io_bridges/serial/pseudo_terminal.hpp"

namespace whirl::cli {
namespace {

TEST(SparkLine, SpansItsOwnRangeAndShowsGaps) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double values[] = {0.0, 1.0, nan, 8.0};
  EXPECT_EQ(spark_line(values), "\u2581\u2582\u00b7\u2588");
  const double flat[] = {3.0, 3.0};
  EXPECT_EQ(spark_line(flat), "\u2584\u2584");
  EXPECT_EQ(spark_line({}), "");
}

class Scope : public testing::Test {
 protected:
  Scope() : line_(std::move(io::PseudoTerminal::open(folder_.file("cell")).value())) {
    const std::string bench =
        "return { bench = \"b\", board = \"esc32v2\", links = {}, instruments = { { name = "
        "\"cell\", path = \"" +
        folder_.file("cell") +
        "\", readings = { { signal = \"thrust\", column = 1, scale = \"1 N\" }, { signal = "
        "\"bus_voltage\", column = 2, "
        "scale = \"1 V\" } } } }, safety = { phrase = \"clear\", longest = \"60 s\" } }";
    EXPECT_TRUE(write_text(folder_.file("b.lua"), bench));
    writer_ = std::thread([this] {
      for (int i = 0; !ending_; ++i) {
        const std::string text = std::to_string(2.0 + 0.5 * std::sin(i * 0.1)) + " 12.25\n";
        line_.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
    });
  }
  ~Scope() override {
    ending_ = true;
    writer_.join();
  }
  static std::string shell(const std::string& line, int expected) {
    std::FILE* pipe = popen((line + " 2>&1").c_str(), "r");
    std::string text;
    char piece[4096];
    for (std::size_t n; (n = std::fread(piece, 1, sizeof piece, pipe)) > 0;) text.append(piece, n);
    const int status = pclose(pipe);
    EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, expected) << text;
    return text;
  }
  std::string command(const std::string& more) const {
    return std::string(WHIRL_PROGRAM) + " bench scope " + folder_.file("b.lua") + more;
  }

  ScratchFolder folder_;
  io::PseudoTerminal line_;
  std::atomic<bool> ending_ = false;
  std::thread writer_;
};

TEST_F(Scope, WithoutATerminalRowsOfTextAreWritten) {
  const std::string text = shell(command(" --seconds 0.5 --column 0.1 < /dev/null"), 0);
  EXPECT_NE(text.find(" bus_voltage 12.25 V\n"), std::string::npos) << text;
  EXPECT_NE(text.find(" thrust "), std::string::npos) << text;
}

// script(1) gives it a terminal; the key comes through that.
TEST_F(Scope, OnATerminalRowsAreRedrawnUntilQ) {
  const std::string text = shell(
      "(sleep 1; printf q; sleep 5) | timeout 10 script -qec '" + command("") + "' /dev/null", 0);
  EXPECT_NE(text.find("thrust"), std::string::npos) << text;
  EXPECT_NE(text.find("\x1b[H"), std::string::npos);
  EXPECT_NE(text.find("12.25 V"), std::string::npos) << text;
  EXPECT_TRUE(text.find("\u2588") != std::string::npos || text.find("\u2584") != std::string::npos)
      << text;
}

TEST_F(Scope, WhatIsNotThereIsOneLine) {
  ASSERT_TRUE(write_text(folder_.file("n.lua"),
                         "return { bench = \"n\", board = \"esc32v2\", links = {}, instruments = "
                         "{}, safety = { phrase = \"clear\", longest = \"60 s\" } }"));
  EXPECT_NE(shell(std::string(WHIRL_PROGRAM) + " bench scope " + folder_.file("n.lua"), 2)
                .find("has nothing that a scope can show"),
            std::string::npos);
  EXPECT_NE(shell(std::string(WHIRL_PROGRAM) + " bench probe " + folder_.file("n.lua") + " x", 2)
                .find("names no debug probe"),
            std::string::npos);
}

}  // namespace
}  // namespace whirl::cli
