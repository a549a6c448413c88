// The bench's loop with links that a test plays, on a clock that passes when it is told to.
#include "harness/target/bench/bench_target.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "harness/pacing/tests/told_clock.hpp"

namespace whirl::bench {
namespace {

constexpr std::int64_t kMs = 1'000'000;

struct Played {  // what a link was told, and what it shall say
  std::vector<std::int64_t> taken_due_ns, served_ns;
  Arrivals says;
  std::optional<Error> fails, refuses;
  int made_safe = 0, opened = 0, closed = 0;
  bool silent_loop = false;
  BenchTime time;
  std::vector<std::int64_t> served_virtual_ns;  // by that
};

class PlayedLink final : public Link {
 public:
  explicit PlayedLink(Played& played) : p_(played) {}
  std::string name() const override { return "played"; }
  Result<Done> open() override {
    ++p_.opened;
    if (p_.refuses) return *p_.refuses;
    return Done{};
  }
  void keep_time(BenchTime time) override { p_.time = std::move(time); }
  bool take(const io::Reader& order, std::int64_t due_host_ns) override {
    if (order.header().kind != io::Kind::uart_frame) return false;
    p_.taken_due_ns.push_back(due_host_ns);
    return true;
  }
  Result<Done> serve(std::int64_t now_host_ns, Arrivals& arrivals) override {
    p_.served_ns.push_back(now_host_ns);
    p_.served_virtual_ns.push_back(p_.time.virtual_ns(now_host_ns));
    while (!p_.says.empty() && p_.says.front().host_ns <= now_host_ns) {
      arrivals.push_back(p_.says.front());
      p_.says.erase(p_.says.begin());
    }
    if (p_.fails) return *p_.fails;
    return Done{};
  }
  void make_safe() override { ++p_.made_safe; }
  bool heartbeat_lost() const override { return p_.silent_loop; }
  void close() override { ++p_.closed; }

 private:
  Played& p_;
};

struct Rig {
  explicit Rig(double pace = 1.0, std::size_t links = 1) : played(links) {
    BenchOptions options;
    options.real_time = false;
    options.bench.name = "b";
    options.bench.pace = pace;
    options.bench.late_ns = 200'000;
    options.bench.safety.longest_ns = 1000 * kMs;
    options.bench.safety.heartbeat_ns = 100 * kMs;
    options.operator_stops = [this] { return enter; };
    std::vector<std::unique_ptr<Link>> all;
    for (Played& one : played) all.push_back(std::make_unique<PlayedLink>(one));
    target.emplace(std::move(options), std::move(all), clock);
  }
  Result<TargetState> step(const io::Batch& sensed = {}) {
    t_ns += kMs;
    happened.clear();
    target->run(t_ns, sensed);
    return target->arrive(happened);
  }
  std::vector<io::Header> headers() const {
    std::vector<io::Header> all;
    for (io::Reader r(happened.bytes()); r.next();) all.push_back(r.header());
    return all;
  }

  pacing::ToldClock clock;
  std::int64_t begin_ns = clock.t_ns, t_ns = 0;
  bool enter = false;
  std::vector<Played> played;
  io::Batch happened;
  std::optional<BenchTarget> target;
};

io::Batch frame_at(std::int64_t t_ns) {
  io::Batch batch;
  batch.add(io::Kind::uart_frame, 1, t_ns, "x", 1);
  return batch;
}

TEST(BenchTarget, AStepTakesItsTimeOfTheHostWhateverThePace) {
  for (const double pace : {1.0, 0.05}) {
    Rig rig(pace);
    ASSERT_TRUE(rig.target->start().ok());
    for (int k = 0; k < 10; ++k) ASSERT_TRUE(rig.step().ok());
    EXPECT_EQ(rig.clock.t_ns - rig.begin_ns, std::llround(10.0 * kMs / pace)) << pace;
    EXPECT_EQ(rig.target->held_pace()->lateness_s.size(), 10u);
    EXPECT_EQ(rig.target->held_pace()->late_steps, 0);
  }
}

TEST(BenchTarget, ALinksTimeIsVirtualAndNeverBeyondTheStepAtHand) {
  Rig rig(0.5);
  ASSERT_TRUE(rig.target->start().ok());
  for (int k = 0; k < 5; ++k) ASSERT_TRUE(rig.step().ok());
  EXPECT_EQ(rig.played[0].served_virtual_ns.back(), 5 * kMs);
  EXPECT_EQ(rig.played[0].time.due_host_ns(7 * kMs), rig.begin_ns + 14 * kMs);
  rig.clock.t_ns += 50 * kMs;  // a host that is late
  ASSERT_TRUE(rig.step().ok());
  EXPECT_EQ(rig.played[0].served_virtual_ns.back(), 6 * kMs);
}

TEST(BenchTarget, OrdersAreDueWhenTheirVirtualTimeIs) {
  Rig rig(0.5);
  ASSERT_TRUE(rig.target->start().ok());
  ASSERT_TRUE(rig.step(frame_at(kMs / 4)).ok());
  EXPECT_EQ(rig.played[0].taken_due_ns, std::vector<std::int64_t>{rig.begin_ns + kMs / 2});
}

TEST(BenchTarget, WhatCameIsToldInOrderOfItsTimeInVirtualTime) {
  Rig rig(0.5, 2);
  const auto heard = [&](std::int64_t after_ns, std::uint16_t port) {
    return Arrival{rig.begin_ns + after_ns, io::Kind::uart_received, port, {1}};
  };
  rig.played[0].says = {heard(kMs, 1)};
  rig.played[1].says = {heard(kMs / 2, 2), heard(3 * kMs, 3)};
  ASSERT_TRUE(rig.target->start().ok());
  ASSERT_TRUE(rig.step().ok());
  const auto first = rig.headers();
  ASSERT_EQ(first.size(), 2u);
  EXPECT_EQ(first[0].port, 2);
  EXPECT_EQ(first[0].t_ns, kMs / 4);
  EXPECT_EQ(first[1].t_ns, kMs / 2);
  ASSERT_TRUE(rig.step().ok());
  ASSERT_EQ(rig.headers().size(), 1u);
  EXPECT_EQ(rig.headers()[0].t_ns, 3 * kMs / 2);
}

TEST(BenchTarget, ALateHostIsCountedAndAStallGivenUp) {
  Rig rig;
  ASSERT_TRUE(rig.target->start().ok());
  ASSERT_TRUE(rig.step().ok());
  rig.clock.t_ns += kMs + 300'000;  // the step's own millisecond, and 0.3 of the next one
  ASSERT_TRUE(rig.step().ok());
  EXPECT_EQ(rig.target->held_pace()->late_steps, 1);
  rig.clock.t_ns += 500 * kMs;
  ASSERT_TRUE(rig.step().ok());
  EXPECT_GT(rig.target->held_pace()->slipped_ns, 400 * kMs);
}

TEST(BenchTarget, AnEmergencyStopIsSafeAtOnceAndForGood) {
  Rig rig;
  ASSERT_TRUE(rig.target->start().ok());
  ASSERT_TRUE(rig.step().ok());
  io::Batch sensed;
  const std::string why = "current is 30 A";
  sensed.add(io::Kind::emergency_stop, 0, rig.t_ns, why.data(),
             static_cast<std::uint32_t>(why.size()));
  sensed.add(frame_at(rig.t_ns));
  const auto state = rig.step(sensed);
  ASSERT_TRUE(state.ok());
  EXPECT_EQ(state.value(), TargetState::over_limit);
  EXPECT_EQ(rig.target->why_ended(), why);
  EXPECT_EQ(rig.played[0].made_safe, 1);
  EXPECT_TRUE(rig.played[0].taken_due_ns.empty());  // nothing goes out behind it
}

TEST(BenchTarget, TheBenchsLongestTimeEndsTheRun) {
  Rig rig;
  ASSERT_TRUE(rig.target->start().ok());
  for (int k = 1; k < 1000; ++k) ASSERT_EQ(rig.step().value(), TargetState::running);
  const auto over = rig.step();
  ASSERT_FALSE(over.ok());
  EXPECT_EQ(over.error().kind, ErrorKind::bad_input);  // nothing of the firmware's
  EXPECT_EQ(rig.played[0].made_safe, 1);
}

TEST(BenchTarget, OperatorAndLostHeartbeatAreNothingOfTheFirmwares) {
  for (const bool operators : {true, false}) {
    Rig rig;
    ASSERT_TRUE(rig.target->start().ok());
    ASSERT_TRUE(rig.step().ok());
    (operators ? rig.enter : rig.played[0].silent_loop) = true;
    const auto state = rig.step();
    ASSERT_FALSE(state.ok());
    EXPECT_EQ(state.error().kind, ErrorKind::host);
    EXPECT_EQ(rig.played[0].made_safe, 1);
  }
}

TEST(BenchTarget, ALinkThatBreaksMakesTheOthersSafe) {
  Rig rig(1.0, 2);
  ASSERT_TRUE(rig.target->start().ok());
  rig.played[0].fails = Error{ErrorKind::host, "/dev/ttyUSB0", "was unplugged", ""};
  EXPECT_FALSE(rig.step().ok());
  EXPECT_EQ(rig.played[1].made_safe, 1);
}

TEST(BenchTarget, EndsSafeAndClosedOnceAlsoWhenNobodyStopsIt) {
  Played kept;
  {
    Rig rig;
    ASSERT_TRUE(rig.target->start().ok());
    ASSERT_TRUE(rig.step().ok());
    rig.target->stop(rig.happened);
    rig.target->stop(rig.happened);
    EXPECT_EQ(rig.played[0].closed, 1);
    EXPECT_EQ(rig.played[0].made_safe, 1);
  }
  Rig other;
  ASSERT_TRUE(other.target->start().ok());
  other.target.reset();
  EXPECT_EQ(other.played[0].made_safe, 1);
  EXPECT_EQ(other.played[0].closed, 1);
}

TEST(BenchTarget, ALinkThatCannotBeOpenedClosesThoseThatWere) {
  Rig rig(1.0, 3);
  rig.played[1].refuses = Error{ErrorKind::bad_input, "/dev/ttyUSB9", "no such serial line", ""};
  const auto started = rig.target->start();
  ASSERT_FALSE(started.ok());
  EXPECT_EQ(started.error().place, "/dev/ttyUSB9");
  EXPECT_EQ(rig.played[0].closed, 1);
  EXPECT_EQ(rig.played[2].opened, 0);
}

}  // namespace
}  // namespace whirl::bench
