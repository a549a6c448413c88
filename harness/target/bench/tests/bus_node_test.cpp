// This host as a node of a bench's bus, against nodes that the test plays: what they hear, which ids they get, and
// what is found of two of one id and of restarts.
#include "harness/target/bench/bus_node.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "io_bridges/protocols/dronecan/vehicle_state.hpp"

namespace whirl::bench {
namespace {

namespace dc = io::dronecan;
constexpr std::int64_t kMillisecond = 1'000'000, kSecond = 1'000'000'000;

dc::UniqueId unique(std::uint8_t seed) {
  dc::UniqueId id{};
  for (std::size_t n = 0; n < id.size(); ++n) id[n] = static_cast<std::uint8_t>(seed + n);
  return id;
}

// A node of the bus, with what it has heard.
struct Other {
  explicit Other(std::uint8_t id) : node(id, "org.example.esc", [](const io::CanFrame&) {}) {}
  template <typename Message>
  int heard() const {
    return static_cast<int>(std::count(types.begin(), types.end(), Message::kType.id));
  }
  void hear(const std::vector<io::CanFrame>& frames, std::int64_t now_ns) {
    for (const io::CanFrame& frame : frames) {
      const dc::Transfer* transfer = node.on_frame(frame, now_ns);
      if (transfer == nullptr) continue;
      types.push_back(transfer->header.type_id);
      if (const auto arming = node.read<dc::ArmingStatus>(*transfer)) armed = arming->status;
      if (const auto given = node.read<dc::Allocation>(*transfer)) allocation = *given;
      if (const auto info = node.read<dc::GetNodeInfoResponse>(*transfer)) name = info->name_text();
    }
  }

  dc::LocalNode node;
  std::vector<std::uint16_t> types;
  int armed = -1;
  std::string name;
  dc::Allocation allocation;
};

struct Bus {
  explicit Bus(BusNodeOptions options = {.node = 10, .arms = true})
      : host(options, [this](const io::CanFrame& frame) { sent.push_back(frame); }) {}
  void run_until(std::int64_t end_ns) {
    for (; now_ns < end_ns; now_ns += kMillisecond) {
      host.poll(now_ns);
      listener.hear(std::exchange(sent, {}), now_ns);
    }
  }
  template <typename Message>
  void put(const Message& message, std::uint8_t source, std::uint8_t transfer_id,
           std::uint8_t destination = 0) {
    const auto payload = dc::encode(message);
    const dc::Header header{.kind = Message::kType.kind,
                            .type_id = Message::kType.id,
                            .priority = 24,
                            .source = source,
                            .destination = destination,
                            .transfer_id = transfer_id};
    for (const auto& frame : dc::frames_of(header, Message::kType.signature, payload.bytes())) {
      host.on_frame(frame, now_ns);
    }
    listener.hear(std::exchange(sent, {}), now_ns);
  }
  // A node without id asks, part by part, as the protocol orders it. 0: it got none.
  std::uint8_t ask(const dc::UniqueId& id, std::uint8_t wanted = 0) {
    listener.allocation = {};
    for (const auto& [from, count] : {std::pair{0, 6}, {6, 6}, {12, 4}}) {
      dc::Allocation part{.node_id = wanted, .first_part = from == 0};
      for (int n = from; n < from + count; ++n) part.unique_id.add(id[static_cast<std::size_t>(n)]);
      put(part, 0, 0);
      run_until(now_ns + 100 * kMillisecond);
    }
    return listener.allocation.unique_id.items == id ? listener.allocation.node_id : 0;
  }
  void status(std::uint8_t node, std::uint32_t uptime_s, std::uint8_t transfer_id) {
    put(dc::NodeStatus{.uptime_s = uptime_s}, node, transfer_id & 31);
  }

  std::int64_t now_ns = 0;
  std::vector<io::CanFrame> sent;
  Other listener{20};
  BusNode host;
};

TEST(BusNode, TellsItsStatusEachSecondArmsTwiceAsOftenAndSaysWhoItIs) {
  Bus bus;
  bus.run_until(10 * kSecond);
  EXPECT_EQ(bus.listener.heard<dc::NodeStatus>(), 10);
  EXPECT_EQ(bus.listener.heard<dc::ArmingStatus>(), 20);
  EXPECT_EQ(bus.listener.armed, 255);
  bus.put(dc::GetNodeInfoRequest{}, 20, 0, 10);
  EXPECT_EQ(bus.listener.name, "whirl.bench");
}

TEST(BusNode, OneThatDoesNotArmNeverSaysSo) {
  Bus bus({.node = 11});
  bus.run_until(5 * kSecond);
  EXPECT_EQ(bus.listener.heard<dc::ArmingStatus>(), 0);
  EXPECT_EQ(bus.listener.heard<dc::NodeStatus>(), 5);
}

TEST(BusNode, ANodeGetsTheIdThatIsKeptForItElseOneOfTheRange) {
  const NodeIds ids{.lowest = 100, .highest = 102, .kept = {{unique(7), 20}}};
  Bus bus({.node = 10, .arms = true, .ids = ids});
  bus.run_until(2 * kSecond);
  EXPECT_EQ(bus.ask(unique(1)), 102);
  EXPECT_EQ(bus.ask(unique(7), 101), 20);  // whatever it wanted
  EXPECT_EQ(bus.ask(unique(1)), 102);      // it has restarted
  EXPECT_EQ(bus.ask(unique(2), 100), 100);
  EXPECT_EQ(bus.ask(unique(3), 50), 101);
  EXPECT_EQ(bus.ask(unique(4)), 0);
  const auto findings = bus.host.findings();
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_NE(findings[0].find("none of the range is free"), std::string::npos);
  const auto figures = bus.host.figures();
  ASSERT_EQ(figures.size(), 4u);
  EXPECT_EQ(figures[1].first, "node id 20 given to");
  EXPECT_EQ(figures[1].second, "0708090a0b0c0d0e0f10111213141516");
}

TEST(BusNode, GivesNoIdBeforeItHasHeardWhoIsThereNorOneThatIsInUse) {
  Bus bus({.node = 10, .ids = {.lowest = 9, .highest = 12}});
  bus.run_until(kMillisecond);
  EXPECT_EQ(bus.ask(unique(1)), 0);
  bus.status(12, 100, 0);
  bus.run_until(kSecond + kMillisecond);
  EXPECT_EQ(bus.ask(unique(1)), 11);
  EXPECT_EQ(bus.ask(unique(2)), 9);  // 10 is ours
}

TEST(BusNode, AListenerAnswersNothing) {
  Bus bus(BusNodeOptions{});
  bus.run_until(2 * kSecond);
  EXPECT_EQ(bus.ask(unique(1)), 0);
  bus.put(dc::GetNodeInfoRequest{}, 20, 0, 10);
  bus.status(30, 5, 0);
  EXPECT_TRUE(bus.listener.types.empty());
}

TEST(BusNode, AsksWhoAppearsAndTellsIt) {
  Bus bus;
  bus.status(30, 5, 0);
  EXPECT_EQ(bus.host.figures()[0].second, "has not said who it is");
  dc::GetNodeInfoResponse info{.software_major = 2, .software_minor = 18, .unique_id = unique(1)};
  info.set_name("org.example.esc");
  bus.put(info, 30, 0, 10);
  ASSERT_EQ(bus.host.figures().size(), 1u);
  EXPECT_EQ(bus.host.figures()[0].first, "node 30");
  EXPECT_EQ(bus.host.figures()[0].second,
            "org.example.esc, version 2.18, unique id 0102030405060708090a0b0c0d0e0f10");
  EXPECT_TRUE(bus.host.findings().empty());
  info.unique_id = unique(2);
  bus.put(info, 30, 1, 10);
  ASSERT_EQ(bus.host.findings().size(), 1u);
  EXPECT_NE(bus.host.findings()[0].find("two nodes have id 30"), std::string::npos);
}

TEST(BusNode, FindsANodeThatRestarted) {
  Bus bus;
  std::uint8_t transfer_id = 0;
  for (std::uint32_t s = 100; s < 104; ++s) {
    bus.status(30, s, transfer_id++);
    bus.run_until(bus.now_ns + kSecond);
  }
  EXPECT_TRUE(bus.host.findings().empty());
  for (std::uint32_t s = 0; s < 40; ++s) {
    bus.status(30, s, static_cast<std::uint8_t>(s));
    bus.run_until(bus.now_ns + kSecond);
  }
  EXPECT_EQ(
      bus.host.findings(),
      std::vector<std::string>{"node 30 restarted 1 times in this run, first heard at 4.0 s"});
}

TEST(BusNode, FindsTwoNodesOfOneId) {
  Bus bus;
  for (std::uint32_t s = 0; s < 5; ++s) {
    bus.status(30, 100 + s, static_cast<std::uint8_t>(s));
    bus.run_until(bus.now_ns + 400 * kMillisecond);
    bus.status(30, 7 + s, static_cast<std::uint8_t>(s));
    bus.run_until(bus.now_ns + 600 * kMillisecond);
  }
  ASSERT_EQ(bus.host.findings().size(), 1u);
  EXPECT_NE(bus.host.findings()[0].find("two nodes have id 30"), std::string::npos);
}

TEST(BusNode, FindsAnotherNodeOfOurId) {
  Bus bus;
  bus.status(10, 100, 0);
  ASSERT_EQ(bus.host.findings().size(), 1u);
  EXPECT_NE(bus.host.findings()[0].find("another node has id 10"), std::string::npos);
  Bus played(BusNodeOptions{});  // parts are played as 30
  const auto payload = dc::encode(dc::NodeStatus{});
  const dc::Header header{.type_id = dc::NodeStatus::kType.id, .source = 30};
  played.host.on_own(
      dc::frames_of(header, dc::NodeStatus::kType.signature, payload.bytes()).front());
  EXPECT_TRUE(played.host.findings().empty());
  played.status(30, 100, 0);
  ASSERT_EQ(played.host.findings().size(), 1u);
  EXPECT_NE(played.host.findings()[0].find("another node has id 30"), std::string::npos);
}

}  // namespace
}  // namespace whirl::bench
