// A vehicle's nodes on a bus in memory: their time is the bench's, their frames are the bus's, and they fall silent.
#include "harness/target/bench/node_link.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "io_bridges/protocols/dronecan/esc.hpp"
#include "io_bridges/protocols/dronecan/transfer.hpp"
#include "io_bridges/rack/devices/table.hpp"
#include "io_bridges/socketcan/tests/memory_can.hpp"

namespace whirl::bench {
namespace {

namespace dc = io::dronecan;
constexpr std::int64_t kMs = 1'000'000;

BoardDescription board_with_an_esc() {
  BoardDescription board;
  board.name = "afar";
  board.devices.push_back({.name = "esc1", .type = "esc_dronecan", .bus = "can2", .motor = 1});
  return board;
}

BoardDescription pods_board() {
  BoardDescription board;
  board.name = "pod";
  board.devices.push_back({.name = "host", .type = "pod_parts"});
  board.devices.back().set("params.can", 2.0);
  return board;
}

// The host's clock and virtual time run as one, but for what is said of them.
struct Rig {
  explicit Rig(std::uint16_t bus = 2, BoardDescription board = board_with_an_esc(),
               bool pod = false, std::optional<std::uint8_t> allocator = {})
      : link({.link = {.name = "bus", .interface = "can0", .bus = bus, .allocator = allocator},
              .board = std::move(board),
              .types = rack::device_types(),
              .pod = pod ? std::optional(PodPlaces{}) : std::nullopt},
             [this](const CanBusLink&) -> Result<std::unique_ptr<io::CanPort>> {
               return wire.join();
             }) {
    link.keep_time({[this](std::int64_t host_ns) { return std::min(host_ns, until_ns); },
                    [](std::int64_t t_ns) { return t_ns; }});
  }
  void serve_until(std::int64_t host_ns) {
    while (now_ns < host_ns) {
      now_ns += kMs / 4;
      ASSERT_TRUE(link.serve(now_ns, arrivals).ok());
    }
  }
  std::size_t of_kind(io::Kind kind) const {
    return static_cast<std::size_t>(std::count_if(
        arrivals.begin(), arrivals.end(), [&](const Arrival& a) { return a.kind == kind; }));
  }

  std::int64_t now_ns = 0, until_ns = 1000 * kMs;
  io::MemoryCan wire{[this] { return now_ns; }};
  NodeLink link;
  Arrivals arrivals;
};

io::CanFrame command(std::int16_t counts) {
  dc::RawCommand raw;
  raw.commands.add(counts);
  const auto payload = dc::encode(raw);
  const dc::Header header{.type_id = 1030, .priority = 5, .source = 10};
  return dc::frames_of(header, dc::RawCommand::kType.signature, payload.bytes()).front();
}

TEST(NodeLink, ASetPointOfTheWireArrivesAtItsTimeAndStatusesGoOut) {
  Rig rig;
  ASSERT_TRUE(rig.link.open().ok());
  rig.serve_until(30 * kMs);
  rig.wire.put(command(400));
  rig.serve_until(130 * kMs);
  const auto arrival = std::find_if(rig.arrivals.begin(), rig.arrivals.end(), [](const Arrival& a) {
    return a.kind == io::Kind::esc_setpoint;
  });
  ASSERT_NE(arrival, rig.arrivals.end());
  EXPECT_EQ(rig.of_kind(io::Kind::esc_setpoint), 1u);  // once, not with each turn
  EXPECT_EQ(arrival->port, 1);
  io::EscSetpoint setpoint;
  ASSERT_EQ(arrival->payload.size(), sizeof setpoint);
  std::memcpy(&setpoint, arrival->payload.data(), sizeof setpoint);
  EXPECT_EQ(setpoint.value, 100);
  // Its frame of some 100 bits begins when it came, at 30 ms.
  EXPECT_GT(arrival->host_ns, 30 * kMs);
  EXPECT_LT(arrival->host_ns, 30 * kMs + 300'000);
  // esc.Status and its extension at 11.3, 61.3 and 111.3 ms: three frames and one.
  EXPECT_EQ(rig.wire.seen().size(), 1 + 3 * 4u);
}

TEST(NodeLink, OwnFramesThatComeBackAreNotAnothers) {
  Rig rig;
  ASSERT_TRUE(rig.link.open().ok());
  rig.serve_until(130 * kMs);
  EXPECT_GT(rig.of_kind(io::Kind::can_transfer), 0u);
  for (const Arrival& a : rig.arrivals) {
    if (a.kind != io::Kind::can_transfer) continue;
    io::CanRecord record;
    ASSERT_EQ(a.payload.size(), sizeof record);
    std::memcpy(&record, a.payload.data(), sizeof record);
    EXPECT_EQ(record.sender, 0);  // the ESC's number, never the microcontroller's
  }
}

TEST(NodeLink, AHostThatIsLateHasItsNodesWait) {
  Rig rig;
  ASSERT_TRUE(rig.link.open().ok());
  rig.until_ns = 5 * kMs;
  rig.serve_until(100 * kMs);
  EXPECT_TRUE(rig.wire.seen().empty());
  rig.until_ns = 15 * kMs;
  rig.serve_until(101 * kMs);
  EXPECT_EQ(rig.wire.seen().size(), 4u);
}

TEST(NodeLink, NodesThatAreMadeSafeFallSilent) {
  Rig rig;
  ASSERT_TRUE(rig.link.open().ok());
  rig.serve_until(20 * kMs);
  const std::size_t before = rig.wire.seen().size();
  EXPECT_GT(before, 0u);
  rig.link.make_safe();
  rig.serve_until(500 * kMs);
  EXPECT_EQ(rig.wire.seen().size(), before);
}

TEST(NodeLink, WhatFindsNoRoomIsCountedAndTold) {
  Rig rig;
  ASSERT_TRUE(rig.link.open().ok());
  rig.wire.full = true;
  rig.serve_until(2000 * kMs);
  rig.link.close();
  const auto findings = rig.link.findings();
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_NE(findings[1].find("found no room at can0"), std::string::npos) << findings[1];
}

TEST(NodeLink, ABusWithoutDevicesIsRefused) {
  Rig rig(1);
  const auto opened = rig.link.open();
  ASSERT_FALSE(opened.ok());
  EXPECT_EQ(opened.error().kind, ErrorKind::bad_input);
  EXPECT_NE(opened.error().what.find("no device on can1"), std::string::npos);
}

TEST(NodeLink, FindsANodeThatHasTheIdOfAPlayedOne) {
  Rig rig;
  ASSERT_TRUE(rig.link.open().ok());
  rig.serve_until(130 * kMs);
  const auto header = dc::parse_can_id(rig.wire.seen().front().second.id);
  ASSERT_TRUE(header);
  io::CanFrame theirs = command(400);
  theirs.id = dc::can_id({.type_id = 1030, .priority = 5, .source = header->source}, {});
  rig.wire.put(theirs);
  rig.serve_until(131 * kMs);
  rig.link.close();
  const auto findings = rig.link.findings();
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_NE(findings[0].find("can0: another node has id " + std::to_string(header->source)),
            std::string::npos)
      << findings[0];
}

TEST(NodeLink, OnlyANamedAllocatorSpeaksOfItself) {
  for (const bool named : {false, true}) {
    Rig rig(2, board_with_an_esc(), false, named ? std::optional<std::uint8_t>(11) : std::nullopt);
    ASSERT_TRUE(rig.link.open().ok());
    rig.serve_until(130 * kMs);
    const auto seen = rig.wire.seen();
    const auto statuses = std::count_if(seen.begin(), seen.end(), [](const auto& one) {
      const auto header = dc::parse_can_id(one.second.id);
      return header && header->source == 11 && header->type_id == 341;
    });
    EXPECT_EQ(statuses, named ? 1 : 0);
  }
}

TEST(NodeLink, APodsHostOnCanTellsItsPartsAndWhatThePodSays) {
  Rig rig(2, pods_board(), true);
  ASSERT_TRUE(rig.link.open().ok());
  rig.serve_until(1100 * kMs);
  // 105 conversions of the barometer a second, a frame each, and 75 of the magnetometer, two each at least.
  EXPECT_GT(rig.wire.seen().size(), 200u);
  io::Batch happened;
  rig.link.finish([](std::int64_t t_ns) { return t_ns; }, rig.now_ns, happened);
  rig.link.close();
  EXPECT_EQ(rig.link.findings(), std::vector<std::string>{"the pod said nothing"});
}

TEST(NodeLink, APodsHostThatIsOnALineIsNoneOfABus) {
  BoardDescription board = pods_board();
  board.devices.back().set("params.can", 0.0);
  Rig rig(2, board, true);
  EXPECT_FALSE(rig.link.open().ok());
}

TEST(NodeLink, AnAdapterThatIsPulledEndsTheRun) {
  Rig rig;
  ASSERT_TRUE(rig.link.open().ok());
  rig.wire.unplugged = true;
  rig.now_ns = 20 * kMs;
  const auto served = rig.link.serve(rig.now_ns, rig.arrivals);
  ASSERT_FALSE(served.ok());
  EXPECT_EQ(served.error().kind, ErrorKind::host);
}

}  // namespace
}  // namespace whirl::bench
