// The bench's CAN link on a bus in memory: order, what passes, and the zeros of an emergency.
#include "harness/target/bench/can_link.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "harness/pacing/host_clock.hpp"
#include "io_bridges/messages/can_message.hpp"
#include "io_bridges/protocols/dronecan/esc.hpp"
#include "io_bridges/protocols/dronecan/local_node.hpp"
#include "io_bridges/protocols/dronecan/types.hpp"
#include "io_bridges/protocols/dronecan/vehicle_state.hpp"
#include "io_bridges/socketcan/tests/memory_can.hpp"

namespace whirl::bench {
namespace {

namespace dc = io::dronecan;
constexpr std::int64_t kMillisecond = 1'000'000;

std::int64_t clock_ns() {
  return pacing::MonotonicClock().now_ns();
}

io::CanFrame raw_command(std::int16_t counts, std::uint8_t transfer_id) {
  dc::RawCommand raw;
  raw.commands.add(counts);
  const auto payload = dc::encode(raw);
  const dc::Header header{.type_id = 1030, .priority = 5, .source = 10, .transfer_id = transfer_id};
  return dc::frames_of(header, dc::RawCommand::kType.signature, payload.bytes()).front();
}

struct Rig {
  explicit Rig(std::int64_t heartbeat_ns = 0)
      : link({.link = {"bus", "can0"}, .heartbeat_ns = heartbeat_ns},
             [this](const CanBusLink&) -> Result<std::unique_ptr<io::CanPort>> {
               return bus.join();
             }) {
    EXPECT_TRUE(link.open().ok());
  }
  bool order(const io::CanFrame& frame, std::int64_t due_ns = 0, std::uint16_t on = 1) {
    io::Batch batch;
    batch.add(io::Kind::can_order, on, 0, io::to_message(frame));
    io::Reader r(batch.bytes());
    r.next();
    return link.take(r, due_ns);
  }
  void begin() {
    link.keep_time({[this](std::int64_t) { return run_ns; }, [](std::int64_t) { return 0; }});
  }
  Result<Done> serve() { return link.serve(clock_ns(), arrivals); }
  // As an ESC that holds the last command: its receiver refuses what repeats a transfer id.
  std::vector<int> commands_taken() {
    dc::Assembler assembler(dc::known_type);
    std::vector<int> all;
    for (const auto& [t_ns, frame] : bus.seen()) {
      const auto* transfer = assembler.take(frame, t_ns);
      if (transfer == nullptr || transfer->header.type_id != 1030) continue;
      all.push_back(dc::decode<dc::RawCommand>(transfer->payload)->commands.items[0]);
    }
    return all;
  }
  // Pre: a thread is at work. A test that waits for ever is ended by ctest.
  void wait_for_frames(std::size_t n) {
    while (bus.seen().size() < n) pacing::MonotonicClock().sleep_until(clock_ns() + kMillisecond);
  }

  std::int64_t run_ns = 0;  // virtual
  io::MemoryCan bus{clock_ns};
  CanLink link;
  Arrivals arrivals;
};

TEST(CanLink, OrdersOfItsBusGoOutInOrderAndNotBeforeTheirTime) {
  Rig rig;
  EXPECT_TRUE(rig.order(raw_command(1, 0)));
  EXPECT_TRUE(rig.order(raw_command(2, 1), clock_ns() + 3'600'000 * kMillisecond));
  EXPECT_FALSE(rig.order(raw_command(3, 2), 0, 2));
  ASSERT_TRUE(rig.serve().ok());
  ASSERT_EQ(rig.bus.seen().size(), 1u);
  EXPECT_EQ(rig.bus.seen()[0].second, raw_command(1, 0));
  EXPECT_GT(rig.link.next_due_host_ns(), clock_ns());
}

TEST(CanLink, WhatPassesIsToldOursMarked) {
  Rig rig;
  rig.order(raw_command(1, 0));
  rig.bus.put(raw_command(7, 3));
  ASSERT_TRUE(rig.serve().ok());
  ASSERT_TRUE(rig.serve().ok());
  ASSERT_EQ(rig.arrivals.size(), 2u);
  const auto sender = [&](std::size_t n) {
    io::CanRecord record;
    std::memcpy(&record, rig.arrivals[n].payload.data(), sizeof record);
    return record.sender;
  };
  EXPECT_EQ(sender(0), -1);
  EXPECT_EQ(sender(1), 0);
}

TEST(CanLink, WhatTheControllerHasNoRoomForWaitsAndIsNotLost) {
  Rig rig;
  rig.bus.full = true;
  rig.order(raw_command(1, 0));
  ASSERT_TRUE(rig.serve().ok());
  EXPECT_TRUE(rig.bus.seen().empty());
  rig.bus.full = false;
  ASSERT_TRUE(rig.serve().ok());
  EXPECT_EQ(rig.bus.seen().size(), 1u);
  EXPECT_EQ(rig.link.monitor().counts().queue_full, 1u);
}

TEST(CanLink, AnEmergencySendsZeroAtOnceAheadOfWhatWaits) {
  Rig rig;
  for (int n = 0; n < 5; ++n) rig.order(raw_command(4000, static_cast<std::uint8_t>(n)));
  ASSERT_TRUE(rig.serve().ok());
  rig.order(raw_command(5000, 5));
  const std::int64_t before_ns = clock_ns();
  rig.link.make_safe();
  EXPECT_FALSE(rig.bus.seen().size() == 5u);  // it is out when the call returns
  rig.order(raw_command(6000, 6));
  ASSERT_TRUE(rig.serve().ok());
  rig.wait_for_frames(5 + 4 * 4);
  const std::vector<int> taken = rig.commands_taken();
  ASSERT_GE(taken.size(), 8u);
  EXPECT_EQ(taken[4], 4000);
  EXPECT_TRUE(std::all_of(taken.begin() + 5, taken.end(), [](int c) { return c == 0; }));
  EXPECT_LT(rig.bus.seen()[5].first - before_ns, 20 * kMillisecond);
}

// An ESC that was commanded by speeds listens to those.
TEST(CanLink, TheZerosAreOfBothKindsOfCommandForAllEscs) {
  Rig rig;
  rig.link.make_safe();
  dc::Assembler assembler(dc::known_type);
  int raw = 0, speeds = 0;
  for (const auto& [t_ns, frame] : rig.bus.seen()) {
    const auto* transfer = assembler.take(frame, t_ns);
    if (transfer == nullptr) continue;
    const auto all_zero = [](const auto& list) {
      return list.size == 4 && std::all_of(list.items.begin(), list.items.begin() + 4,
                                           [](auto count) { return count == 0; });
    };
    if (const auto r = dc::decode<dc::RawCommand>(transfer->payload);
        r && transfer->header.type_id == dc::RawCommand::kType.id) {
      raw += all_zero(r->commands) ? 1 : 0;
    }
    if (const auto r = dc::decode<dc::RpmCommand>(transfer->payload);
        r && transfer->header.type_id == dc::RpmCommand::kType.id) {
      speeds += all_zero(r->speeds_rpm) ? 1 : 0;
    }
  }
  EXPECT_GE(raw, 1);
  EXPECT_GE(speeds, 1);
}

// What the nodes of the bus hear of this host, of type `Message`.
template <typename Message>
std::vector<Message> heard(Rig& rig) {
  dc::Assembler assembler(dc::known_type);
  std::vector<Message> all;
  for (const auto& [t_ns, frame] : rig.bus.seen()) {
    const auto* transfer = assembler.take(frame, t_ns);
    if (transfer == nullptr || transfer->header.type_id != Message::kType.id ||
        transfer->header.kind != Message::kType.kind || transfer->header.source != 10) {
      continue;
    }
    all.push_back(*dc::decode<Message>(transfer->payload));
  }
  return all;
}

TEST(CanLink, IsANodeThatArmsFromTheRunsBeginUntilItIsSafe) {
  Rig rig;
  rig.order(raw_command(0, 0));
  ASSERT_TRUE(rig.serve().ok());
  EXPECT_TRUE(heard<dc::NodeStatus>(rig).empty());  // the run has not begun
  rig.begin();
  rig.run_ns = 1'100 * kMillisecond;
  ASSERT_TRUE(rig.serve().ok());
  rig.run_ns = 2'200 * kMillisecond;
  ASSERT_TRUE(rig.serve().ok());
  EXPECT_EQ(heard<dc::NodeStatus>(rig).size(), 2u);
  EXPECT_EQ(heard<dc::NodeStatus>(rig).back().uptime_s, 1u);
  ASSERT_EQ(heard<dc::ArmingStatus>(rig).size(), 2u);
  EXPECT_EQ(heard<dc::ArmingStatus>(rig).back().status, 255);

  rig.bus.full = true;  // an order to arm waits
  rig.run_ns = 3'300 * kMillisecond;
  ASSERT_TRUE(rig.serve().ok());
  rig.bus.full = false;
  rig.link.make_safe();
  rig.run_ns = 4'400 * kMillisecond;
  ASSERT_TRUE(rig.serve().ok());
  rig.link.close();
  const auto arming = heard<dc::ArmingStatus>(rig);
  ASSERT_GE(arming.size(), 3u);
  EXPECT_TRUE(std::all_of(arming.begin() + 2, arming.end(),
                          [](const dc::ArmingStatus& a) { return a.status == 0; }));
  EXPECT_EQ(heard<dc::NodeStatus>(rig).size(), 2u);
}

TEST(CanLink, AnswersWhoItIsAndFindsARestart) {
  Rig rig;
  rig.begin();
  dc::LocalNode esc(20, "org.example.esc", [&](const io::CanFrame& f) { rig.bus.put(f); });
  esc.request(dc::GetNodeInfoRequest{}, 10);
  esc.broadcast(dc::NodeStatus{.uptime_s = 100}, 24);
  esc.broadcast(dc::NodeStatus{.uptime_s = 3}, 24);
  ASSERT_TRUE(rig.serve().ok());
  ASSERT_TRUE(rig.serve().ok());
  EXPECT_EQ(heard<dc::GetNodeInfoRequest>(rig).size(), 2u);  // of who appeared, and restarted
  const auto answers = heard<dc::GetNodeInfoResponse>(rig);
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].name_text(), "whirl.bench");
  rig.link.close();
  const auto findings = rig.link.findings();
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_NE(findings[0].find("can0: node 20 restarted 1 times"), std::string::npos);
}

TEST(CanLink, ALostHeartbeatSendsZerosByItself) {
  Rig rig(30 * kMillisecond);
  rig.order(raw_command(4000, 0));
  ASSERT_TRUE(rig.serve().ok());
  const std::int64_t heard_ns = clock_ns();
  rig.wait_for_frames(4);
  EXPECT_GE(rig.bus.seen()[1].first - heard_ns, 25 * kMillisecond);
  EXPECT_TRUE(rig.link.heartbeat_lost());
  EXPECT_EQ(rig.commands_taken()[1], 0);
}

TEST(CanLink, ClosingSendsAZero) {
  Rig rig;
  rig.order(raw_command(4000, 0));
  ASSERT_TRUE(rig.serve().ok());
  rig.link.close();
  EXPECT_EQ(rig.commands_taken(), (std::vector<int>{4000, 0}));
}

TEST(CanLink, BusOffAndALostAdapterAreErrorsOfTheHost) {
  Rig rig;
  rig.bus.put(io::CanTrouble{.no_acknowledge = true});
  ASSERT_TRUE(rig.serve().ok());
  rig.bus.put(io::CanTrouble{.bus_off = true, .state = io::CanBusState::bus_off});
  const auto served = rig.serve();
  ASSERT_FALSE(served.ok());
  EXPECT_EQ(served.error().kind, ErrorKind::host);
  EXPECT_NE(served.error().message().find("bus-off"), std::string::npos);
  rig.link.close();
  ASSERT_EQ(rig.link.findings().size(), 1u);
  EXPECT_NE(rig.link.findings()[0].find("1 unacknowledged"), std::string::npos);

  Rig other;
  other.bus.unplugged = true;
  other.order(raw_command(1, 0));
  EXPECT_FALSE(other.serve().ok());
}

TEST(CanLink, APortThatCannotBeOpenedIsRefused) {
  CanLink link({.link = {"bus", "can77"}},
               [](const CanBusLink&) -> Result<std::unique_ptr<io::CanPort>> {
                 return Error{ErrorKind::bad_input, "can77", "no such CAN interface", ""};
               });
  EXPECT_FALSE(link.open().ok());
  link.make_safe();  // nothing to make safe
}

}  // namespace
}  // namespace whirl::bench
