#include "results/event_log.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace whirl::results {
namespace {

TEST(Events, ATruncatedBatchIsNoticed) {
  io::Batch batch;
  batch.add(io::Kind::data_ready, 0, 5, nullptr, 0);
  io::Batch cut;
  cut.assign(batch.bytes().first(batch.bytes().size() - 1));
  EventLog log;
  EXPECT_TRUE(log.add(batch));
  EXPECT_FALSE(log.add(cut));
}

TEST(Events, BusyShareCountsWholePiecesOfTheWindow) {
  EventLog log;
  log.busy = {{0, 100, 90}, {100, 200, 20}, {200, 300, 40}, {300, 400, 90}};
  EXPECT_EQ(log.busy_share(100, 350), 0.3);
  EXPECT_TRUE(std::isnan(log.busy_share(110, 190)));
  log.busy = {{0, 100, INT64_MAX}, {5, INT64_MIN, INT64_MAX}};  // of a board gone mad
  EXPECT_TRUE(std::isnan(log.busy_share(0, 100)));
}

TEST(EventLog, APinsFirstMessageIsItsLevelAndNoEdge) {
  EventLog log;
  io::Batch batch;
  for (const auto& [t_ns, level] :
       {std::pair<int, int>{0, 1}, {10, 0}, {30, 1}, {35, 0}, {50, 1}}) {
    batch.add(io::Kind::pin_edge, 4, t_ns, io::PinEdge{static_cast<std::uint8_t>(level), {}});
  }
  ASSERT_TRUE(log.add(batch));
  ASSERT_EQ(log.pulses[4].size(), 2u);
  EXPECT_EQ(log.pulses[4][0].rise_ns, 30);
  EXPECT_EQ(log.pulses[4][0].fall_ns, 35);
  EXPECT_EQ(log.pulses[4][1].fall_ns, -1);
}

TEST(EventLog, AFrameThatCouldNotBeReadIsKeptApartFromTransfers) {
  EventLog log;
  io::Batch batch;
  batch.add(io::Kind::bus_unread, 3, 200, io::BusUnread{100, 1, {}}, "why", 3);
  ASSERT_TRUE(log.add(batch));
  EXPECT_TRUE(log.bus.empty());
  ASSERT_EQ(log.unread.size(), 1u);
  EXPECT_TRUE(log.unread[0].spi);
  EXPECT_EQ(log.unread[0].bus, 3);
  EXPECT_EQ(log.unread[0].start_ns, 100);
  EXPECT_EQ(log.unread[0].stop_ns, 200);
}

}  // namespace
}  // namespace whirl::results
