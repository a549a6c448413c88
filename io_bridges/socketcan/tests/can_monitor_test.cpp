#include "io_bridges/socketcan/can_monitor.hpp"

#include <gtest/gtest.h>

#include "base/near.hpp"

namespace whirl::io {
namespace {

CanFrame long_frame() {
  return {.id = 0x1804060A, .extended = true, .length = 8};
}

CanArrival sent(std::int64_t host_ns) {
  CanArrival arrival;
  arrival.host_ns = host_ns;
  arrival.own = true;
  arrival.frame = long_frame();
  return arrival;
}

// Eight bytes with a 29-bit identifier: 131 bits without stuff bits, 160 with the most (ISO 11898-1).
TEST(CanMonitor, TheLoadLiesBetweenNoStuffBitsAndTheMost) {
  CanMonitor monitor(1'000'000);
  for (int n = 0; n < 2000; ++n) monitor.on_arrival(sent(n * std::int64_t{500'000}));
  const auto load = monitor.load_between(0, 1'000'000'000);
  EXPECT_TRUE(near(load.least, 0.262, round_off(8, 1.0)));
  EXPECT_TRUE(near(load.most, 0.320, round_off(8, 1.0)));
  monitor.on_arrival(sent(1'000'000'000));  // the second is over
  EXPECT_TRUE(near(monitor.fullest_second().least, 0.262, round_off(8, 1.0)));
}

// A remote frame asks for eight bytes and carries none: 67 bits without stuff bits.
TEST(CanMonitor, ARemoteFrameLoadsTheBusWithoutData) {
  CanMonitor monitor(1'000'000);
  CanArrival asked = sent(0);
  asked.frame.remote = true;
  monitor.on_arrival(asked);
  EXPECT_TRUE(near(monitor.load_between(0, 1'000'000).least, 0.067, round_off(8, 1.0)));
}

TEST(CanMonitor, AVirtualBusHasNoLoad) {
  CanMonitor monitor(0);
  monitor.on_arrival(sent(0));
  EXPECT_EQ(monitor.load_between(0, 1'000'000'000).most, 0.0);
}

TEST(CanMonitor, TroubleIsCountedByItsKind) {
  CanMonitor monitor(1'000'000);
  CanArrival off;
  off.trouble = CanTrouble{.bus_off = true, .state = CanBusState::bus_off};
  monitor.on_arrival(off);
  EXPECT_EQ(monitor.counts().state, CanBusState::bus_off);
  CanArrival again;
  again.trouble = CanTrouble{.restarted = true, .state = CanBusState::active};
  monitor.on_arrival(again);
  CanArrival frame{.frame = long_frame(), .dropped = 3};
  monitor.on_arrival(frame);
  const CanCounts& c = monitor.counts();
  EXPECT_EQ(c.bus_off, 1u);
  EXPECT_EQ(c.restarted, 1u);
  EXPECT_EQ(c.error_frames, 2u);
  EXPECT_EQ(c.received, 1u);
  EXPECT_EQ(c.dropped, 3u);
  EXPECT_EQ(c.state, CanBusState::active);
  EXPECT_NE(monitor.text().find("1 times bus-off"), std::string::npos);
}

}  // namespace
}  // namespace whirl::io
