// Both ends of a serial line on this host: a pseudo-terminal is played, a Tty opens it.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <numeric>
#include <optional>

#include "base/scratch_folder.hpp"
#include "io_bridges/serial/line_cutter.hpp"
#include "io_bridges/serial/pseudo_terminal.hpp"
#include "io_bridges/serial/tty.hpp"

namespace whirl::io {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Line {
  PseudoTerminal far = std::move(PseudoTerminal::open().value());
  Tty near = std::move(Tty::open(far.path(), 115200).value());
};

Bytes read_all(Tty& tty) {
  Bytes all, some(512);
  for (std::size_t n = 1; n > 0;) {
    const auto got = tty.read(some);
    EXPECT_TRUE(got.ok());
    n = got ? got.value() : 0;
    all.insert(all.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(n));
  }
  return all;
}

TEST(Tty, CarriesEveryByteBothWaysUntouched) {
  Line line;
  Bytes every(256);
  std::iota(every.begin(), every.end(), std::uint8_t{0});
  line.far.write(every);
  EXPECT_EQ(read_all(line.near), every);  // no echo, no CR for LF, no XON, no ^C
  ASSERT_TRUE(line.near.write(every).ok());
  Bytes got(1000);
  got.resize(line.far.read(got));
  EXPECT_EQ(got, every);
  EXPECT_EQ(read_all(line.near), Bytes());
}

TEST(Tty, WhatTheKernelDoesNotTakeGoesLater) {
  Line line;
  const Bytes much(60'000, 'x');
  ASSERT_TRUE(line.near.write(much).ok());
  EXPECT_GT(line.near.kept_B(), 0u);
  std::size_t arrived = 0;
  Bytes some(4096);
  for (int i = 0; i < 1000 && arrived < much.size(); ++i) {
    arrived += line.far.read(some);
    ASSERT_TRUE(line.near.flush().ok());
  }
  EXPECT_EQ(arrived, much.size());
  EXPECT_EQ(line.near.kept_B(), 0u);
}

TEST(Tty, ALineThatIsNotReadIsTold) {
  Line line;
  const Bytes much(60'000, 'x');
  ASSERT_TRUE(line.near.write(much).ok());
  const auto more = line.near.write(much);
  ASSERT_FALSE(more.ok());
  EXPECT_EQ(more.error().kind, ErrorKind::host);
}

TEST(Tty, UnpluggedIsSaidByBothReadAndWrite) {
  std::optional<PseudoTerminal> far = std::move(PseudoTerminal::open().value());
  Tty near = std::move(Tty::open(far->path(), 9600).value());
  far.reset();
  Bytes some(16);
  const auto got = near.read(some);
  ASSERT_FALSE(got.ok());
  EXPECT_EQ(got.error().kind, ErrorKind::host);
  EXPECT_FALSE(near.write(Bytes{1}).ok());
}

TEST(Tty, AnyRateIsSetThatTheDriverMakes) {
  PseudoTerminal far = std::move(PseudoTerminal::open().value());
  for (const int baud : {9600, 57600, 100'000, 921'600, 3'000'000}) {
    EXPECT_TRUE(Tty::open(far.path(), baud).ok()) << baud;
  }
}

// By root as well, who may open what is marked as held.
TEST(Tty, WhatAnotherHoldsIsRefusedUntilItIsLeft) {
  PseudoTerminal far = std::move(PseudoTerminal::open().value());
  {
    const auto held = Tty::open(far.path(), 9600);
    ASSERT_TRUE(held.ok());
    const auto second = Tty::open(far.path(), 9600);
    ASSERT_FALSE(second.ok());
    EXPECT_EQ(second.error().what, "another program holds it");
  }
  EXPECT_TRUE(Tty::open(far.path(), 9600).ok());
}

TEST(Tty, RefusesWhatIsNoSerialLineInOneSentence) {
  const ScratchFolder folder;
  const std::string file = folder.path() + "/plain";
  ::close(::open(file.c_str(), O_CREAT | O_WRONLY, 0600));
  EXPECT_EQ(Tty::open(file, 9600).error().message(), file + ": is no serial line");
  const auto none = Tty::open("/dev/ttyUSB99", 9600);
  EXPECT_EQ(none.error().kind, ErrorKind::bad_input);
  EXPECT_EQ(none.error().what, "no such serial line");
}

TEST(PseudoTerminal, StandsWhereItIsToldAndLeavesNothing) {
  const ScratchFolder folder;
  const std::string link = folder.path() + "/esc";
  {
    const auto terminal = PseudoTerminal::open(link);
    ASSERT_TRUE(terminal.ok());
    EXPECT_TRUE(Tty::open(link, 9600).ok());
    EXPECT_FALSE(PseudoTerminal::open(link).ok());  // it is in use
  }
  EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(link)));
  std::filesystem::create_symlink("/dev/pts/none", link);  // what a crash has left
  EXPECT_TRUE(PseudoTerminal::open(link).ok());
}

TEST(PseudoTerminal, WhatNobodyHearsIsLost) {
  PseudoTerminal far = std::move(PseudoTerminal::open().value());
  { const auto once = Tty::open(far.path(), 9600); }
  EXPECT_FALSE(far.someone_there());
  far.write(Bytes{1, 2, 3});
  EXPECT_EQ(far.lost_B(), 3u);
  Tty near = std::move(Tty::open(far.path(), 9600).value());
  EXPECT_EQ(read_all(near), Bytes());
}

std::vector<std::string> cut(LineCutter& cutter, const std::string& text) {
  std::vector<std::string> lines;
  cutter.add({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()},
             [&](std::string_view line) { lines.emplace_back(line); });
  return lines;
}

TEST(LineCutter, WholeLinesOnlyWhateverThePieces) {
  LineCutter cutter;
  EXPECT_EQ(cut(cutter, "13 N\r\n2.5"), std::vector<std::string>{});  // the first began before us
  EXPECT_EQ(cut(cutter, "1 N\r"), std::vector<std::string>{"2.51 N"});
  EXPECT_EQ(cut(cutter, "\n2.6\n\n2.7\r\n"), (std::vector<std::string>{"2.6", "2.7"}));
}

TEST(LineCutter, GarbageWithoutAnEndIsLeftOutAndCounted) {
  LineCutter cutter;
  cut(cutter, "\n" + std::string(5000, '9'));
  EXPECT_EQ(cut(cutter, "\n1\n"), std::vector<std::string>{"1"});
  EXPECT_EQ(cutter.left_out(), 1u);
}

TEST(NumbersOf, TakesWhatStandsAloneAndIsFinite) {
  EXPECT_EQ(numbers_of("2.013, 5012;-0.4"), (std::vector<double>{2.013, 5012.0, -0.4}));
  EXPECT_EQ(numbers_of("thrust +2.5e-1 N speed=5012 N2 2.0.1 nan inf -"),
            (std::vector<double>{0.25, 5012.0}));
  EXPECT_EQ(numbers_of(""), std::vector<double>{});
}

}  // namespace
}  // namespace whirl::io
