// Oracle: the order that Target promises. What happens in a step reaches the world in the next one, and
// what is sensed in a step reaches the target in the next one.
#include "harness/lockstep/lockstep.hpp"

#include <gtest/gtest.h>

namespace whirl {
namespace {

std::vector<std::int64_t> times(const io::Batch& batch) {
  std::vector<std::int64_t> all;
  for (io::Reader r(batch.bytes()); r.next();) all.push_back(r.header().t_ns);
  return all;
}

class Echo final : public World {  // its one signal is the time of what it saw last
 public:
  const std::vector<Signal>& signals() const override { return signals_; }
  void read(std::span<double> values) const override { values[0] = static_cast<double>(seen_ns_); }
  void step(std::int64_t t_ns, const io::Batch& happened, io::Batch& sensed) override {
    for (const std::int64_t t : times(happened)) seen_ns_ = t;
    sensed.add(io::Kind::body_motion, 0, t_ns, io::BodyMotion{});
  }
  Result<Done> command(const Command&, std::int64_t) override { return Done{}; }
  Result<Done> disturb(const Disturbance&, std::int64_t) override { return Done{}; }
  Result<bool> take_fault(const FaultSpec&) override { return false; }
  std::vector<std::uint32_t> applied_faults() const override { return {}; }
  std::string status() const override { return ""; }

 private:
  std::vector<Signal> signals_{{"seen", Dimension::none, ""}};
  std::int64_t seen_ns_ = -1;
};

class Clockwork final : public Target {
 public:
  Result<Done> start() override { return Done{}; }
  void run(std::int64_t until_ns, const io::Batch& sensed) override {
    until_ns_ = until_ns;
    given = times(sensed);
  }
  Result<TargetState> arrive(io::Batch& happened) override {
    happened.add(io::Kind::data_ready, 0, until_ns_ - 1, nullptr, 0);
    if (until_ns_ == lost_at_ns) return Error{ErrorKind::host, "host", "too late", ""};
    return TargetState::running;
  }
  void stop(io::Batch& happened) override {
    happened.add(io::Kind::data_ready, 0, until_ns_, nullptr, 0);
  }
  Offers offers() const override { return kAll_offers; }
  std::vector<std::pair<std::string, std::string>> versions() const override { return {}; }

  std::vector<std::int64_t> given;
  std::int64_t lost_at_ns = -1;

 private:
  std::int64_t until_ns_ = 0;
};

TEST(Lockstep, WhatOneDoesReachesTheOtherInTheNextStep) {
  Echo world;
  Clockwork target;
  Lockstep lockstep(world, target);
  ASSERT_TRUE(lockstep.start().ok());
  EXPECT_EQ(lockstep.row()[0], -1.0);
  std::vector<std::int64_t> sent;
  const auto keep = [&](const io::Batch& batch) { sent = times(batch); };
  ASSERT_TRUE(lockstep.step(keep).ok());
  EXPECT_EQ(target.given, std::vector<std::int64_t>{0});
  EXPECT_EQ(sent, target.given);
  EXPECT_EQ(lockstep.row()[0], -1.0);  // the world took this step without it
  EXPECT_EQ(times(lockstep.happened()), std::vector<std::int64_t>{kLockstep_ns - 1});
  ASSERT_TRUE(lockstep.step(keep).ok());
  EXPECT_EQ(target.given, std::vector<std::int64_t>{kLockstep_ns});
  EXPECT_EQ(lockstep.row()[0], static_cast<double>(kLockstep_ns - 1));
  EXPECT_EQ(lockstep.now_ns(), 2 * kLockstep_ns);
}

TEST(Lockstep, WhatIsAddedBetweenStepsGoesWithTheNextOne) {
  Echo world;
  Clockwork target;
  Lockstep lockstep(world, target);
  ASSERT_TRUE(lockstep.start().ok());
  lockstep.to_send().add(io::Kind::fault, 1, 7, nullptr, 0);
  ASSERT_TRUE(lockstep.step().ok());
  EXPECT_EQ(target.given, (std::vector<std::int64_t>{0, 7}));
}

TEST(Lockstep, ATargetThatIsLostLeavesTheTimeWhereItWasAndWhatItStillTold) {
  Echo world;
  Clockwork target;
  target.lost_at_ns = 2 * kLockstep_ns;
  Lockstep lockstep(world, target);
  ASSERT_TRUE(lockstep.start().ok());
  ASSERT_TRUE(lockstep.step().ok());
  EXPECT_FALSE(lockstep.step().ok());
  EXPECT_EQ(lockstep.now_ns(), kLockstep_ns);
  EXPECT_EQ(times(lockstep.happened()), std::vector<std::int64_t>{2 * kLockstep_ns - 1});
  lockstep.stop();
  EXPECT_EQ(times(lockstep.happened()), std::vector<std::int64_t>{2 * kLockstep_ns});
}

}  // namespace
}  // namespace whirl
