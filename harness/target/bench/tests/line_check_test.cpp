// The check of a serial line against ends that the test plays on a pseudo-terminal, on a clock that passes as it waits.
#include "harness/target/bench/line_check.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string_view>

#include "io_bridges/protocols/ubx.hpp"
#include "io_bridges/serial/pseudo_terminal.hpp"

namespace whirl::bench {
namespace {

constexpr std::int64_t kMs_ns = 1'000'000;

struct LineClock final : pacing::HostClock {
  std::int64_t t_ns = 1'000'000'000;
  std::function<void(std::int64_t)> turn = [](std::int64_t) {};
  std::int64_t now_ns() const override { return t_ns; }
  void sleep_until(std::int64_t until_ns) override { wait_for({}, until_ns); }
  void wait_for(std::span<pollfd>, std::int64_t until_ns) override {
    t_ns = std::max(t_ns, std::min(until_ns, t_ns + kMs_ns));
    turn(t_ns);
  }
};

struct Played {
  LineClock clock;
  io::PseudoTerminal far = std::move(io::PseudoTerminal::open().value());
  double baud = 0.0;  // that the line was set to

  Result<std::vector<std::string>> check(LineEnd end, int gps_baud = 9600) {
    return check_line({.link = {"line", far.path(), 1, 921600}, .end = end, .gps_baud = gps_baud},
                      clock);
  }
  std::string said(LineEnd end) {
    const auto told = check(end);
    return told ? told.value().at(0) : "MISSING " + told.error().message();
  }
  void say(std::string_view text) {
    far.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  // after_ms: until a question is answered; 0: never.
  void answers_after(int after_ms) {
    clock.turn = [this, after_ms, asked_ns = std::int64_t{-1}](std::int64_t t_ns) mutable {
      baud = far.baud();
      std::array<std::uint8_t, 64> bytes;
      if (far.read(bytes) > 0) asked_ns = t_ns;
      if (after_ms == 0 || asked_ns < 0 || t_ns < asked_ns + after_ms * kMs_ns) return;
      asked_ns = -1;
      say("status 0\r\n");
    };
  }
};

bool has(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

TEST(LineCheck, ACommandLineIsAskedAndItsAnswersAreTimed) {
  Played line;
  line.answers_after(3);
  const std::string said = line.said(LineEnd::commands);
  EXPECT_TRUE(has(said, "answered 20 of 20 times")) << said;
  // Heard with the question's turn, a millisecond behind it: 3 to 5 ms.
  EXPECT_TRUE(has(said, "p50 4.00, p99 4.00, most 4.00 ms") || has(said, "p50 3.00, p99 3.00"))
      << said;
  EXPECT_EQ(line.baud, 921600.0);
}

TEST(LineCheck, OneThatSaysNothingIsMissingAndOneThatTalksAnywayIsNotTimed) {
  Played silent;
  silent.answers_after(0);
  EXPECT_TRUE(has(silent.said(LineEnd::commands), "MISSING")) << silent.said(LineEnd::commands);
  Played talks;
  talks.clock.turn = [&](std::int64_t t_ns) {
    if (t_ns % (10 * kMs_ns) == 0) talks.say("1 2\r\n");
  };
  const std::string said = talks.said(LineEnd::commands);
  EXPECT_TRUE(has(said, "B in 2 s, 50")) << said;
  EXPECT_TRUE(has(said, "cannot be told from what it says anyway")) << said;
}

TEST(LineCheck, OfAGpsLineItsMessagesAreCountedAndNothingIsAsked) {
  Played line;
  const auto poll = io::encode(io::UbxFrame{0x06, 0x00, {}});
  std::size_t asked_B = 0;
  line.clock.turn = [&](std::int64_t t_ns) {
    std::array<std::uint8_t, 64> bytes;
    asked_B += line.far.read(bytes);
    line.baud = line.far.baud();
    if (t_ns % (100 * kMs_ns) == 0) line.far.write(poll);
  };
  const auto told = line.check(LineEnd::gps, 38400);
  ASSERT_TRUE(told.ok());
  EXPECT_TRUE(has(told.value()[0], "38400 baud 8N1")) << told.value()[0];
  EXPECT_TRUE(has(told.value()[0], ", 20 messages of UBX")) << told.value()[0];
  EXPECT_TRUE(has(told.value()[0], "cannot be known before a run")) << told.value()[0];
  EXPECT_EQ(asked_B, 0u);
  EXPECT_EQ(line.baud, 38400.0);
  Played other;
  other.clock.turn = [&](std::int64_t t_ns) {
    if (t_ns % (100 * kMs_ns) == 0) other.say("garbage");
  };
  EXPECT_TRUE(has(other.said(LineEnd::gps), "no message of UBX among them"));
  Played silent;
  EXPECT_TRUE(has(silent.said(LineEnd::gps), "nothing comes"));
}

TEST(LineCheck, AReceiversLineIsMadeAndWhatComesOnItIsOdd) {
  Played line;
  line.answers_after(0);
  const std::string quiet = line.said(LineEnd::receiver);
  EXPECT_TRUE(has(quiet, "100000 baud 8E2, SBUS: nothing comes, as it should be")) << quiet;
  EXPECT_EQ(line.baud, 100'000.0);
  line.clock.turn = [&](std::int64_t) { line.say("x"); };
  const std::string odd = line.said(LineEnd::receiver);
  EXPECT_TRUE(has(odd, "where a receiver's line brings nothing")) << odd;
}

TEST(LineCheck, APulledLineIsTheHosts) {
  Played line;
  line.clock.turn = [&](std::int64_t) { const auto gone = std::move(line.far); };
  const auto told = line.check(LineEnd::gps);
  ASSERT_FALSE(told.ok());
  EXPECT_EQ(told.error().kind, ErrorKind::host);
}

}  // namespace
}  // namespace whirl::bench
