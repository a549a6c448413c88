// Bits of 1 us: a time in microseconds is a count of bits. Expected lengths are ISO 11898-1's, counted
// by hand where the text says so.
#include "io_bridges/devices/can_bus.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "io_bridges/devices/can_wire_faults.hpp"

namespace whirl::io {
namespace {

constexpr Nanoseconds kBit = 1000, kIdle = 11 * kBit;

CanFrame frame_of(std::uint32_t id, std::uint8_t length = 0, std::uint8_t fill = 0) {
  CanFrame frame;
  frame.id = id;
  frame.extended = true;
  frame.length = length;
  for (unsigned i = 0; i < length; ++i) frame.data[i] = fill;
  return frame;
}

struct Node : CanNode {
  CanBus* bus = nullptr;
  CanStation* station = nullptr;
  std::deque<CanFrame> queue;
  std::vector<std::pair<Nanoseconds, CanFrame>> received;
  std::vector<Nanoseconds> sent_at, lost_at, off_at, joined_at;
  std::vector<CanError> errors;
  bool recovers = false;

  const CanFrame* offered() override { return queue.empty() ? nullptr : &queue.front(); }
  void sent(Nanoseconds now) override {
    sent_at.push_back(now);
    queue.pop_front();
  }
  void receive(const CanFrame& frame, Nanoseconds now) override {
    received.emplace_back(now, frame);
  }
  void lost_arbitration(Nanoseconds now) override { lost_at.push_back(now); }
  void failed(CanError error, bool, Nanoseconds) override { errors.push_back(error); }
  void bus_off(Nanoseconds now) override {
    off_at.push_back(now);
    if (recovers) bus->connect(*station, 128);
  }
  void joined(Nanoseconds now) override { joined_at.push_back(now); }
  void send(const CanFrame& frame) {
    queue.push_back(frame);
    bus->request(*station);
  }
};

struct Bus {
  EventQueue events;
  FaultBook book;
  std::vector<Finding> findings;
  CanBus bus{events, "can1", [this](const Finding& f) { findings.push_back(f); }};
  CanWireFaults faults{events, book, bus, 1, 1000.0};
  std::vector<CanTransfer> log;
  std::vector<std::uint32_t> applied;
  std::deque<Node> nodes;

  explicit Bus(int count, double bit_ns = 1000.0) {
    bus.on_transfer([this](const CanTransfer& t) { log.push_back(t); });
    book.on_applied([this](std::uint32_t number, Nanoseconds) { applied.push_back(number); });
    for (int i = 0; i < count; ++i) add(bit_ns, i - 1);  // the first is the microcontroller
    events.run_until(kIdle);
  }
  Node& add(double bit_ns, int number) {
    Node& node = nodes.emplace_back();
    node.bus = &bus;
    node.station = &bus.join(node, "node" + std::to_string(nodes.size()), number);
    bus.configure(*node.station, bit_ns);
    bus.connect(*node.station, 1);
    return node;
  }
  void fault(FaultKind kind, Nanoseconds from, Nanoseconds to, double value = 0.0,
             int address = kAnywhere) {
    book.add({.number = 7,
              .kind = kind,
              .start_ns = from,
              .end_ns = to,
              .bus = 1,
              .address = address,
              .value = value});
  }
};

// What every receiver does: takes out each bit behind five equal ones, and divides by the polynomial.
TEST(CanBits, AreStuffedAndLeaveNoRemainder) {
  for (std::uint32_t i = 0; i < 400; ++i) {
    CanFrame frame = frame_of(i * 0x9E3779B1u >> 3, static_cast<std::uint8_t>(i % 9),
                              static_cast<std::uint8_t>(i * 37));
    frame.extended = i % 3 != 0;
    if (!frame.extended) frame.id &= 0x7FF;
    const CanBits bits = can_bits(frame);
    std::vector<int> plain;
    int run = 0;
    for (int k = 0; k < bits.count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      if (run == 5) {
        ASSERT_NE(bits.value[at], bits.value[at - 1]) << i;
        run = 1;
        continue;
      }
      run = k > 0 && bits.value[at] == bits.value[at - 1] ? run + 1 : 1;
      plain.push_back(bits.value[at]);
    }
    ASSERT_EQ(plain.size(), (frame.extended ? 54u : 34u) + 8u * frame.length) << i;
    std::uint32_t remainder = 0;
    for (const int bit : plain) {
      remainder = remainder << 1 | static_cast<std::uint32_t>(bit);
      if ((remainder & 0x8000) != 0) remainder ^= 0xC599;  // x^15+x^14+x^10+x^8+x^7+x^4+x^3+1
    }
    EXPECT_EQ(remainder, 0u) << i;
  }
}

TEST(CanBus, TheLowerIdentifierGoesFirstAndTheOtherRightAfterTheIntermission) {
  Bus b(3);
  b.nodes[1].send(frame_of(0x1F0, 2, 0xAA));
  b.nodes[0].send(frame_of(0x0F0, 2, 0xAA));
  b.events.run_until(1'000'000);
  ASSERT_EQ(b.nodes[2].received.size(), 2u);
  EXPECT_EQ(b.nodes[2].received[0].second.id, 0x0F0u);
  ASSERT_EQ(b.nodes[1].lost_at.size(), 1u);
  EXPECT_EQ(b.log[0].losers, 1);
  EXPECT_EQ(b.log[1].start_ns - b.log[0].end_ns, 3 * kBit);
  EXPECT_EQ(b.log[0].end_ns - b.log[0].start_ns,
            (can_frame_bits(frame_of(0x0F0, 2, 0xAA)) - 3) * kBit);
}

// A base identifier beats the extended one that begins with it; of equal ones data beats remote.
TEST(CanBus, ArbitratesOnTheWholeField) {
  CanFrame base;
  base.id = 0x123;
  EXPECT_LT(can_arbitration(base), can_arbitration(frame_of(0x123u << 18)));
  EXPECT_LT(can_arbitration(frame_of(0x122u << 18 | 0x3FFFF)), can_arbitration(base));
  CanFrame remote = base;
  remote.remote = true;
  EXPECT_LT(can_arbitration(base), can_arbitration(remote));
  EXPECT_EQ(can_bit_lost(can_arbitration(base), can_arbitration(remote)), 11);
}

// 16 failures bring TEC to 128; from there a missing acknowledge no longer counts.
TEST(CanBus, AloneItTurnsPassiveAndNeverBusOff) {
  Bus b(1);
  b.nodes[0].send(frame_of(5));
  b.events.run_until(10'000'000);
  EXPECT_EQ(b.nodes[0].station->tec(), 128);
  EXPECT_TRUE(b.nodes[0].station->passive());
  EXPECT_FALSE(b.nodes[0].station->is_bus_off());
  EXPECT_EQ(b.log[0].error, CanError::acknowledge);
  // Up to the slot, flag of six, delimiter of eight, intermission; passive: eight more.
  const Nanoseconds attempt = (can_bits(frame_of(5)).count + 2 + 6 + 8 + 3) * kBit;
  EXPECT_EQ(b.log[1].start_ns - b.log[0].start_ns, attempt);
  EXPECT_EQ(b.log[20].start_ns - b.log[19].start_ns, attempt + 8 * kBit);
}

TEST(CanBus, SpoiledFramesTakeTheirSenderOffTheBusAfter32AndBackAfter128Idles) {
  Bus b(2);
  b.nodes[0].recovers = true;
  b.fault(FaultKind::can_bit_error, 0, 20'000'000);
  b.nodes[0].send(frame_of(0x100, 8, 0x5A));
  b.events.run_until(20'000'000);
  ASSERT_GE(b.nodes[0].off_at.size(), 2u);  // it comes back and fails again
  EXPECT_EQ(b.log[31].tec, 256);
  EXPECT_EQ(b.nodes[0].off_at[0], b.log[31].end_ns);
  // The delimiter's eight bits and the intermission's three are the first of the 128 runs.
  EXPECT_EQ(b.nodes[0].joined_at.at(1), b.nodes[0].off_at[0] - 8 * kBit + 128 * kIdle);
  EXPECT_TRUE(b.nodes[1].received.empty());
  EXPECT_EQ(b.applied, std::vector<std::uint32_t>{7});
  ASSERT_FALSE(b.findings.empty());
  EXPECT_EQ(b.findings[0].what, "node1 went bus-off");
}

TEST(CanBus, TheNthFrameOnlyIsSpoiledAndSentAgain) {
  Bus b(2);
  b.fault(FaultKind::can_bit_error, 0, kNever, 2);
  for (std::uint32_t id = 1; id <= 3; ++id) b.nodes[0].send(frame_of(id, 8, 0x5A));
  b.events.run_until(2'000'000);
  ASSERT_EQ(b.log.size(), 4u);
  EXPECT_NE(b.log[1].error, CanError::none);
  EXPECT_EQ(b.log[2].frame, b.log[1].frame);
  EXPECT_EQ(b.nodes[1].received.size(), 3u);
  EXPECT_EQ(b.nodes[0].station->tec(), 6);  // + 8 - 1 - 1
  // Together the flags are six bits at least and twelve at most.
  const Nanoseconds flags = b.log[1].end_ns - b.log[1].start_ns - (b.log[1].bit + 1 + 8) * kBit;
  EXPECT_GE(flags, 6 * kBit);
  EXPECT_LE(flags, 12 * kBit);
}

TEST(CanBus, NodesOfTwoBitRatesBreakEachOthersFramesAndThatIsSaid) {
  Bus b(2);
  b.add(2000.0, 3);
  b.events.run_until(100'000);
  b.nodes[0].send(frame_of(0x55, 4, 0x00));
  b.events.run_until(3'000'000);
  ASSERT_FALSE(b.findings.empty());
  EXPECT_EQ(b.findings[0].what, "node3 runs at 500 kbit/s, node1 at 1000 kbit/s");
  EXPECT_NE(b.log[0].error, CanError::none);
  EXPECT_GT(b.nodes[2].station->rec(), 0);
}

// Once the one of the wrong rate is passive its flags no longer disturb.
TEST(CanBus, AfterSomeFramesTheOneOfAnotherRateIsPassive) {
  Bus b(2);
  b.add(2000.0, 3);
  b.events.run_until(100'000);
  b.nodes[0].send(frame_of(0x55, 4, 0x00));
  b.events.run_until(30'000'000);
  EXPECT_TRUE(b.nodes[2].station->passive());
  EXPECT_EQ(b.nodes[1].received.size(), 1u);
}

TEST(CanBus, AHeldWireMakesReceiversPassiveAndASenderLeave) {
  Bus b(3);
  b.nodes[0].send(frame_of(0x10, 8, 0x55));
  b.fault(FaultKind::can_stuck_dominant, kIdle + 60 * kBit, kIdle + 1'000 * kBit);
  b.events.run_until(kIdle + 999 * kBit);
  EXPECT_TRUE(b.nodes[0].station->is_bus_off());
  EXPECT_TRUE(b.nodes[1].station->passive());
  EXPECT_FALSE(b.nodes[1].station->is_bus_off());
  // 31 more counts of eight after the first, one in eight bits, the first after six more.
  EXPECT_EQ(b.nodes[0].off_at.at(0), kIdle + (60 + 6 + 31 * 8) * kBit);
  b.nodes[1].send(frame_of(0x11));
  b.events.run_until(kIdle + 1'200 * kBit);
  ASSERT_EQ(b.nodes[2].received.size(), 1u);
  EXPECT_EQ(b.log.back().start_ns, kIdle + (1'000 + 11) * kBit);
}

TEST(CanBus, ADeviceCutOffHearsNothingAndCountsUp) {
  Bus b(3);
  b.fault(FaultKind::can_cut, 0, 5'000'000, 0.0, 0);  // nodes[1]
  b.nodes[0].send(frame_of(1));
  b.nodes[1].send(frame_of(2));
  b.events.run_until(5'000'000);
  EXPECT_EQ(b.nodes[0].sent_at.size(), 1u);  // the third acknowledges
  EXPECT_TRUE(b.nodes[1].received.empty());
  EXPECT_EQ(b.nodes[1].station->tec(), 128);
  b.events.run_until(6'000'000);
  EXPECT_EQ(b.nodes[1].sent_at.size(), 1u);
}

TEST(CanBus, TheWholeBusCutLeavesTheMicrocontrollerAlone) {
  Bus b(2);
  b.fault(FaultKind::can_cut, 0, 5'000'000);
  b.nodes[0].send(frame_of(1));
  b.events.run_until(5'000'000);
  EXPECT_EQ(b.nodes[0].station->tec(), 128);
  b.events.run_until(6'000'000);
  EXPECT_EQ(b.nodes[1].received.size(), 1u);
}

TEST(CanBus, WithoutItsAcknowledgeAFrameIsNotSent) {
  Bus b(2);
  b.fault(FaultKind::can_no_ack, 0, 500'000);
  b.nodes[0].send(frame_of(1));
  b.events.run_until(499'000);
  EXPECT_TRUE(b.nodes[0].sent_at.empty());
  b.events.run_until(1'000'000);
  EXPECT_EQ(b.nodes[0].sent_at.size(), 1u);
}

TEST(CanBus, ALostFrameIsAcknowledgedAndALateOneWaits) {
  Bus b(2);
  b.fault(FaultKind::can_lost, 0, 1'000'000, 0.0, 0);
  b.nodes[0].send(frame_of(1));
  b.events.run_until(1'000'000);
  EXPECT_EQ(b.nodes[0].sent_at.size(), 1u);
  EXPECT_TRUE(b.nodes[1].received.empty());
  b.fault(FaultKind::can_late, 1'000'000, kNever, 3e-3);
  b.nodes[0].send(frame_of(2));
  b.events.run_until(10'000'000);
  EXPECT_EQ(b.log.back().start_ns, 4'000'000);
}

TEST(CanBus, ABabblingNodeTakesItsShareOrAllOfTheBus) {
  for (const double share : {0.0, 0.5}) {
    Bus b(2);
    b.fault(FaultKind::can_babble, kIdle, 10'000'000, share);
    b.events.run_until(1'000'000);
    b.nodes[0].send(frame_of(1));
    b.events.run_until(9'900'000);
    double busy = 0.0;
    for (const CanTransfer& t : b.log) busy += static_cast<double>(t.busy_ns) / 9.9e6;
    EXPECT_EQ(b.nodes[0].sent_at.empty(), share == 0.0);
    EXPECT_GT(busy, share == 0.0 ? 0.98 : 0.49);
    EXPECT_LT(busy, share == 0.0 ? 1.01 : 0.53);
    b.events.run_until(11'000'000);
    EXPECT_EQ(b.nodes[0].sent_at.size(), 1u);
  }
}

TEST(CanBus, TwoOfOneIdentifierCollideBehindIt) {
  Bus b(3);
  b.nodes[0].send(frame_of(0x77, 1, 0x0F));
  b.nodes[1].send(frame_of(0x77, 1, 0xF0));
  b.events.run_until(20'000'000);
  EXPECT_EQ(b.log[0].error, CanError::bit_recessive);
  ASSERT_FALSE(b.findings.empty());
  EXPECT_EQ(b.findings[0].what, "node1 and node2 send one identifier at once");
}

}  // namespace
}  // namespace whirl::io
