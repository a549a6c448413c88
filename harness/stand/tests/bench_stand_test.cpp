// The world of a bench, against instruments and an ESC that are played by hand.
#include "harness/stand/bench_stand.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace whirl::stand {
namespace {

constexpr std::int64_t kBench_ms = 1'000'000;

BenchStandParams params_of_bench() {
  BenchStandParams params;
  params.readings = {{"thrust", Dimension::force, "cell"},
                     {"supply_current", Dimension::current, ""}};
  params.aliases = {{"speed", "told_speed"}};
  params.limits = {{"supply_current", Dimension::current, -1.0, 22.0}};
  return params;
}

struct Played {
  explicit Played(BenchStandParams params = params_of_bench())
      : world(std::move(BenchStand::make(std::move(params)).value())) {}

  void step(std::optional<double> thrust_N, std::optional<double> current_A) {
    io::Batch happened;
    const std::optional<double> readings[] = {thrust_N, current_A};
    for (std::uint16_t port = 0; port < 2; ++port) {
      if (!readings[port]) continue;
      const io::InstrumentReading reading{*readings[port]};
      happened.add(io::Kind::instrument_reading, port, t_ns, reading);
    }
    t_ns += kBench_ms;
    sensed.clear();
    world->step(t_ns, happened, sensed);
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step({}, {});
  }
  double signal(const std::string& name) const {
    std::vector<double> values(world->signals().size());
    world->read(values);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (world->signals()[i].name == name) return values[i];
    }
    ADD_FAILURE() << name;
    return 0.0;
  }
  std::string stop() const {
    for (io::Reader r(sensed.bytes()); r.next();) {
      if (r.header().kind != io::Kind::emergency_stop) continue;
      return {r.payload().begin(), r.payload().end()};
    }
    return "";
  }

  std::unique_ptr<BenchStand> world;
  io::Batch sensed;
  std::int64_t t_ns = 0;
};

TEST(BenchStand, ASignalIsTheLastReadingUntilItIsOld) {
  Played p;
  EXPECT_TRUE(std::isnan(p.signal("thrust")));
  p.step(2.5, 3.0);
  EXPECT_EQ(p.signal("thrust"), 2.5);
  for (int i = 0; i < 240; ++i) p.step({}, 3.0);
  EXPECT_EQ(p.signal("thrust"), 2.5);
  for (int i = 0; i < 20; ++i) p.step({}, 3.0);
  EXPECT_TRUE(std::isnan(p.signal("thrust")));
}

// Also by an alias; what the ESC tells counts as of its step.
TEST(BenchStand, AnInstrumentsSignalIsAsOldAsItsReading) {
  BenchStandParams params = params_of_bench();
  params.aliases["lift"] = "thrust";
  Played p(std::move(params));
  p.step(2.5, {});  // at 0, seen at 1 ms
  p.steps(3);
  const auto ages_ns = p.world->ages_ns();
  for (std::size_t i = 0; i < p.world->signals().size(); ++i) {
    const std::string& name = p.world->signals()[i].name;
    EXPECT_EQ(ages_ns[i], name == "thrust" || name == "lift" ? 4 * kBench_ms : 0) << name;
  }
}

TEST(BenchStand, AnAliasIsTheSignalItNames) {
  Played p;
  const auto status = io::pack_status(0x29, {3.0, 5000.0, 1});
  io::Batch happened;
  const io::I2cReplyHead head{.number = 0, .acked = 1};
  happened.add(io::Kind::i2c_reply, 2, 0, head, status.data(),
               static_cast<std::uint32_t>(status.size()));
  p.world->step(kBench_ms, happened, p.sensed);
  EXPECT_GT(p.signal("speed"), 500.0);
  EXPECT_EQ(p.signal("speed"), p.signal("told_speed"));
}

TEST(BenchStand, BeyondALimitItAsksForSafety) {
  Played p;
  p.steps(500);
  EXPECT_EQ(p.stop(), "");  // an instrument may take its time to begin
  p.step(1.0, 22.0);
  EXPECT_EQ(p.stop(), "");
  p.step(1.0, 22.1);
  EXPECT_NE(p.stop().find("supply_current is 22.1"), std::string::npos) << p.stop();
}

TEST(BenchStand, ALimitThatIsNotMeasuredAnyMoreIsNoLimit) {
  Played p;
  p.step(1.0, 5.0);
  p.steps(249);
  EXPECT_EQ(p.stop(), "");
  p.steps(3);
  EXPECT_NE(p.stop().find("not measured any more"), std::string::npos) << p.stop();
}

TEST(BenchStand, RefusesNamesThatMeanNothingOrTwoThings) {
  const auto refused = [](const std::function<void(BenchStandParams&)>& spoil) {
    BenchStandParams params = params_of_bench();
    spoil(params);
    return !BenchStand::make(std::move(params)).ok();
  };
  EXPECT_FALSE(refused([](BenchStandParams&) {}));
  EXPECT_TRUE(refused([](BenchStandParams& p) { p.aliases["speed"] = "tachometer"; }));
  EXPECT_TRUE(refused([](BenchStandParams& p) { p.aliases["thrust"] = "told_speed"; }));
  EXPECT_TRUE(refused([](BenchStandParams& p) { p.readings[1].name = "thrust"; }));
  EXPECT_TRUE(refused([](BenchStandParams& p) { p.readings[1].name = "told_current"; }));
  EXPECT_TRUE(refused([](BenchStandParams& p) { p.limits[0].signal = "winding_peak"; }));
  EXPECT_TRUE(refused([](BenchStandParams& p) { p.limits[0].dimension = Dimension::voltage; }));
}

TEST(BenchStand, WhatNoBenchCanDoIsRefused) {
  Played p;
  EXPECT_TRUE(p.world->command(request::Stop{}, 0).ok());
  EXPECT_FALSE(p.world->command(request::Brake{}, 0).ok());
  EXPECT_FALSE(p.world->disturb(request::Wind{}, 0).ok());
  FaultSpec dip;
  dip.kind = "supply_dip";
  const auto taken = p.world->take_fault(dip);
  EXPECT_TRUE(taken.ok() && !taken.value());
}

}  // namespace
}  // namespace whirl::stand
