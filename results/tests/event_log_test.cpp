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

}  // namespace
}  // namespace whirl::results
