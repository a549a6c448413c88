// The thread beside the loop, against a master that a test holds back. Times are of the host, and only their
// order is judged.
#include "harness/target/bench/bridge_link.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "harness/pacing/host_clock.hpp"

namespace whirl::bench {
namespace {

constexpr std::int64_t kMs = 1'000'000;
const Transfer kZero{0x29, {0x00, 0x00, 0xF2}, 0};

struct Wire {
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<Transfer> seen;
  bool held = false, unplugged = false, nacks = false;

  // Pre: somebody else works at it. A test that waits for ever is ended by ctest.
  void wait_for(std::size_t transfers) {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return seen.size() >= transfers; });
  }
  void hold(bool on) {
    const std::scoped_lock lock(mutex);
    held = on;
    changed.notify_all();
  }
  std::size_t count() {
    const std::scoped_lock lock(mutex);
    return seen.size();
  }
};

class PlayedPort final : public I2cPort {
 public:
  explicit PlayedPort(Wire& wire) : wire_(wire) {}
  Result<Done> open() override { return Done{}; }
  Result<TransferOutcome> transfer(const Transfer& transfer) override {
    std::unique_lock lock(wire_.mutex);
    wire_.seen.push_back(transfer);
    wire_.changed.notify_all();
    wire_.changed.wait(lock, [&] { return !wire_.held; });
    if (wire_.unplugged) return Error{ErrorKind::host, "bridge", "was unplugged", ""};
    TransferOutcome outcome;
    outcome.acked = !wire_.nacks;
    outcome.bytes.assign(transfer.read, 0x5A);
    outcome.end_host_ns = pacing::MonotonicClock().now_ns();
    return outcome;
  }
  void close() override {}
  std::string version() const override { return "played"; }

 private:
  Wire& wire_;
};

struct Rig {
  explicit Rig(std::int64_t heartbeat_ns = 0)
      : link({"throttle", 2, kZero, heartbeat_ns}, std::make_unique<PlayedPort>(wire)) {
    EXPECT_TRUE(link.open().ok());
  }
  ~Rig() { wire.hold(false); }
  bool order(std::uint32_t number, std::vector<std::uint8_t> write, std::uint16_t read,
             std::int64_t due_ns = 0, std::uint16_t bus = 2) {
    io::Batch batch;
    const io::I2cOrder head{0x29, read, number};
    batch.add(io::Kind::i2c_order, bus, 0, head, write.data(),
              static_cast<std::uint32_t>(write.size()));
    io::Reader r(batch.bytes());
    r.next();
    return link.take(r, due_ns);
  }
  Arrivals answers(std::size_t wanted) {
    Arrivals all;
    while (all.size() < wanted) {
      pollfd file{link.file(), POLLIN, 0};
      poll(&file, 1, 1000);
      EXPECT_TRUE(link.serve(pacing::MonotonicClock().now_ns(), all).ok());
    }
    return all;
  }

  Wire wire;
  BridgeThread link;
};

TEST(BridgeThread, OrdersGoOutInOrderAndAreAnsweredByNumber) {
  Rig rig;
  EXPECT_TRUE(rig.order(7, {1, 2, 3}, 0));
  EXPECT_TRUE(rig.order(8, {}, 6));
  EXPECT_FALSE(rig.order(9, {}, 6, 0, 1));  // another bus
  const Arrivals got = rig.answers(2);
  ASSERT_EQ(got.size(), 2u);
  EXPECT_EQ(rig.wire.seen[0].write, (std::vector<std::uint8_t>{1, 2, 3}));
  EXPECT_EQ(rig.wire.seen[1].read, 6);
  io::I2cReplyHead head;
  std::memcpy(&head, got[1].payload.data(), sizeof head);
  EXPECT_EQ(head.number, 8u);
  EXPECT_EQ(head.acked, 1);
  EXPECT_EQ(got[1].payload.size(), sizeof head + 6);
  EXPECT_LE(got[0].host_ns, got[1].host_ns);
}

TEST(BridgeThread, NothingGoesBeforeItsTime) {
  Rig rig;
  const std::int64_t due_ns = pacing::MonotonicClock().now_ns() + 5 * kMs;
  rig.order(1, {1}, 0, due_ns);
  EXPECT_GE(rig.answers(1)[0].host_ns, due_ns);
}

TEST(BridgeThread, TheLoopDoesNotWaitForASlowTransfer) {
  Rig rig;
  rig.wire.hold(true);
  rig.order(1, {1}, 0);
  rig.wire.wait_for(1);
  Arrivals none;
  EXPECT_TRUE(rig.link.serve(pacing::MonotonicClock().now_ns(), none).ok());  // at once
  EXPECT_TRUE(none.empty());
}

TEST(BridgeThread, SafeGoesAheadOfAllThatWaitsAndAgainAndAgain) {
  Rig rig;
  rig.wire.hold(true);
  rig.order(1, {1}, 0);
  rig.wire.wait_for(1);
  for (std::uint32_t i = 2; i < 20; ++i) rig.order(i, {9, 9, 9}, 0);
  rig.link.make_safe();
  rig.wire.hold(false);
  rig.wire.wait_for(4);
  const std::scoped_lock lock(rig.wire.mutex);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(rig.wire.seen[i].write, kZero.write) << i;
}

TEST(BridgeThread, ALoopThatIsSilentLosesTheStick) {
  Rig rig(20 * kMs);
  rig.order(1, {9, 9, 9}, 0);
  rig.wire.wait_for(3);  // nobody serves
  EXPECT_TRUE(rig.link.heartbeat_lost());
  EXPECT_EQ(rig.wire.seen[2].write, kZero.write);
}

TEST(BridgeThread, TheLastThingOnTheWireIsZero) {
  Wire wire;
  {
    BridgeThread link({"throttle", 2, kZero, 0}, std::make_unique<PlayedPort>(wire));
    ASSERT_TRUE(link.open().ok());
  }
  ASSERT_EQ(wire.seen.size(), 1u);
  EXPECT_EQ(wire.seen[0].write, kZero.write);
}

TEST(BridgeThread, UnpluggedIsToldByTheNextTurn) {
  Rig rig;
  rig.wire.unplugged = true;
  rig.order(1, {1}, 0);
  pollfd file{rig.link.file(), POLLIN, 0};
  poll(&file, 1, -1);
  Arrivals none;
  const auto served = rig.link.serve(pacing::MonotonicClock().now_ns(), none);
  ASSERT_FALSE(served.ok());
  EXPECT_EQ(served.error().kind, ErrorKind::host);
}

TEST(BridgeThread, ANackIsAnAnswer) {
  Rig rig;
  rig.wire.nacks = true;
  rig.order(3, {1}, 0);
  io::I2cReplyHead head;
  std::memcpy(&head, rig.answers(1)[0].payload.data(), sizeof head);
  EXPECT_EQ(head.acked, 0);
}

}  // namespace
}  // namespace whirl::bench
