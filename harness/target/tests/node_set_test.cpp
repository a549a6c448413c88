#include "harness/target/node_set.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <optional>

namespace whirl {
namespace {

// Notes what it is given, and says what it is told to.
class PlayedTarget : public Target {
 public:
  struct Log {
    std::vector<std::pair<io::Header, std::string>> given;
    io::Batch next;  // to be delivered with the next arrive()
    Result<TargetState> state = TargetState::running;
    int stopped = 0;
    std::optional<Error> died, hung;
    std::optional<bool> asks;  // about the others while it is waited for; true: it is silent
  };
  explicit PlayedTarget(Log& log) : log_(log) {}

  Result<Done> start() override { return Done{}; }
  void run(std::int64_t, const io::Batch& sensed) override {
    for (io::Reader r(sensed.bytes()); r.next();) {
      log_.given.emplace_back(r.header(), std::string(r.payload().begin(), r.payload().end()));
    }
  }
  Result<TargetState> arrive(io::Batch& happened) override {
    if (log_.asks) {
      if (const auto other = company_(*log_.asks)) return *other;
    }
    io::add_for_board(log_.next, 0, happened);
    log_.next.clear();
    return log_.state;
  }
  void stop(io::Batch&) override { ++log_.stopped; }
  std::optional<Error> died() override { return log_.died; }
  std::optional<Error> hangs() override { return log_.hung; }
  void set_company(Company ask) override { company_ = std::move(ask); }
  Offers offers() const override { return kAll_offers; }
  std::vector<std::pair<std::string, std::string>> versions() const override {
    return {{"qemu", "7.2"}};
  }

 private:
  Log& log_;
  Company company_;
};

class NodeSets : public ::testing::Test {
 protected:
  NodeSet pair_with(std::vector<UartWire> wires) {
    std::vector<NodeSet::Entry> entries;
    entries.push_back({"fc", std::make_unique<PlayedTarget>(fc_)});
    entries.push_back({"esc", std::make_unique<PlayedTarget>(esc_)});
    return {std::move(entries), std::move(wires)};
  }
  // fc leads, esc follows.
  NodeSet led_pair(io::BoardWire wire) {
    std::vector<NodeSet::Entry> entries;
    entries.push_back({"fc", std::make_unique<PlayedTarget>(fc_)});
    entries.push_back({"esc", std::make_unique<PlayedTarget>(esc_)});
    std::vector<BoardWireLink> links;
    links.push_back({0, 1, std::move(wire)});
    return {std::move(entries), {}, std::move(links)};
  }
  static void send(PlayedTarget::Log& log, std::uint16_t uart, const std::string& text) {
    log.next.add(io::Kind::uart_received, uart, 500'000, text.data(),
                 static_cast<std::uint32_t>(text.size()));
  }

  PlayedTarget::Log fc_, esc_;
};

TEST_F(NodeSets, EachBoardGetsAndSaysItsOwn) {
  NodeSet set = pair_with({});
  io::Batch sensed;
  io::Batch one;
  one.add(io::Kind::body_motion, 7, 0, "m", 1);
  io::add_for_board(one, 0, sensed);
  io::add_for_board(one, 1, sensed);
  set.run(1'000'000, sensed);
  ASSERT_EQ(fc_.given.size(), 1u);
  ASSERT_EQ(esc_.given.size(), 1u);
  EXPECT_EQ(esc_.given[0].first.board, 0);
  EXPECT_EQ(esc_.given[0].first.port, 7);
  send(fc_, 1, "a");
  send(esc_, 1, "b");
  io::Batch happened;
  EXPECT_EQ(set.arrive(happened).value(), TargetState::running);
  io::Reader r(happened.bytes());
  ASSERT_TRUE(r.next());
  EXPECT_EQ(r.header().board, 0);
  ASSERT_TRUE(r.next());
  EXPECT_EQ(r.header().board, 1);
  EXPECT_EQ(set.versions().at(1).first, "esc/qemu");
}

TEST_F(NodeSets, AWireCarriesBothWaysWithTheNextStep) {
  NodeSet set = pair_with({{{0, 2}, {1, 1}}});
  set.run(1'000'000, {});
  send(fc_, 2, "to esc");
  send(fc_, 3, "on another UART");
  send(esc_, 1, "to fc");
  io::Batch happened;
  EXPECT_TRUE(set.arrive(happened).ok());
  EXPECT_TRUE(fc_.given.empty() && esc_.given.empty());
  set.run(2'000'000, {});
  ASSERT_EQ(esc_.given.size(), 1u);
  EXPECT_EQ(esc_.given[0].second, "to esc");
  EXPECT_EQ(esc_.given[0].first.kind, io::Kind::uart_frame);
  EXPECT_EQ(esc_.given[0].first.port, 1);
  EXPECT_EQ(esc_.given[0].first.t_ns, 1'000'000);
  ASSERT_EQ(fc_.given.size(), 1u);
  EXPECT_EQ(fc_.given[0].second, "to fc");
  EXPECT_EQ(fc_.given[0].first.port, 2);
  EXPECT_TRUE(set.arrive(happened).ok());
  set.run(3'000'000, {});
  EXPECT_EQ(fc_.given.size() + esc_.given.size(), 2u);  // once only
}

TEST_F(NodeSets, TheFirstThatEndsOrErrsEndsAllByItsName) {
  NodeSet set = pair_with({});
  esc_.state = TargetState::cpu_locked;
  io::Batch happened;
  set.run(1'000'000, {});
  EXPECT_EQ(set.arrive(happened).value(), TargetState::cpu_locked);
  fc_.state = Error{ErrorKind::host, "QEMU", "is gone", ""};
  set.run(2'000'000, {});
  const auto arrived = set.arrive(happened);
  ASSERT_FALSE(arrived.ok());
  EXPECT_EQ(arrived.error().place, "fc: QEMU");
  set.stop(happened);
  EXPECT_EQ(fc_.stopped + esc_.stopped, 2);
}

// fc is waited for, and waits for the answer of an ESC that is dead.
TEST_F(NodeSets, WhoDiesWhileAnotherWaitsForItIsNamedAndItsWireIsClosed) {
  auto wire = io::BoardWire::create(2);
  auto esc_end = io::BoardWire::attach(dup(wire.value().fd()));
  NodeSet set = led_pair(std::move(wire.value()));
  fc_.asks = false;
  set.run(1'000'000, {});
  io::Batch happened;
  EXPECT_TRUE(set.arrive(happened).ok());  // nobody has died
  EXPECT_TRUE(esc_end.value().post({}));
  esc_.died = Error{ErrorKind::host, "virtual board", "was killed", ""};
  set.run(2'000'000, {});
  const auto arrived = set.arrive(happened);
  ASSERT_FALSE(arrived.ok());
  EXPECT_EQ(arrived.error().place, "esc: virtual board");
  EXPECT_FALSE(esc_end.value().post({}));
}

TEST_F(NodeSets, WhoIsSilentWithoutWaitingForAnotherHangs) {
  auto wire = io::BoardWire::create(2);
  NodeSet set = led_pair(std::move(wire.value()));
  esc_.hung = Error{ErrorKind::host, "virtual board", "was stopped", ""};
  fc_.asks = false;
  set.run(1'000'000, {});
  io::Batch happened;
  EXPECT_TRUE(set.arrive(happened).ok());
  fc_.asks = true;  // its limit has passed
  set.run(2'000'000, {});
  const auto arrived = set.arrive(happened);
  ASSERT_FALSE(arrived.ok());
  EXPECT_EQ(arrived.error().place, "esc: virtual board");
}

// What the leader's end makes of the others is less than what ended it.
TEST_F(NodeSets, ALockedCoreSaysMoreThanTheEndOfThoseThatWaitedForIt) {
  NodeSet set = pair_with({});
  fc_.state = TargetState::ended;
  esc_.state = TargetState::cpu_locked;
  io::Batch happened;
  set.run(1'000'000, {});
  EXPECT_EQ(set.arrive(happened).value(), TargetState::cpu_locked);
}

}  // namespace
}  // namespace whirl
