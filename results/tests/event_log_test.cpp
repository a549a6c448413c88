#include "results/event_log.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "base/scratch_folder.hpp"

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

std::string file_of(const std::vector<std::string>& chunks, const char* name) {
  EventLog log;
  io::Batch batch;
  for (const std::string& chunk : chunks) {
    batch.add(io::Kind::uart_received, 2, 5000, chunk.data(),
              static_cast<std::uint32_t>(chunk.size()));
  }
  EXPECT_TRUE(log.add(batch));
  const ScratchFolder folder;
  EXPECT_EQ(log.telemetry_name(), name);
  EXPECT_TRUE(log.write_telemetry(folder.file(name)));
  std::ostringstream text;
  text << std::ifstream(folder.file(name)).rdbuf();
  return text.str();
}

TEST(Telemetry, IsNamedByWhatItHolds) {
  const std::string us{0, 0, 0, 0, 0, 0, 0, 5};
  EXPECT_EQ(file_of({"\xFD"
                     "frame",
                     "\xFE"
                     "old"},
                    "telemetry.tlog"),
            us +
                "\xFD"
                "frame" +
                us +
                "\xFE"
                "old");
  EXPECT_EQ(file_of({"ready\r\n", "ok"}, "serial.txt"), "ready\r\nok");
}

}  // namespace
}  // namespace whirl::results
