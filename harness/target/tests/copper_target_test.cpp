// A run that a capture judges.
#include "harness/target/copper_target.hpp"

#include <gtest/gtest.h>

#include "base/output_file.hpp"
#include "base/scratch_folder.hpp"

namespace whirl {
namespace {

class IdleTarget final : public Target {
 public:
  Result<Done> start() override { return Done{}; }
  void run(std::int64_t, const io::Batch&) override {}
  Result<TargetState> arrive(io::Batch&) override { return TargetState::running; }
  void stop(io::Batch&) override {}
  std::vector<std::pair<std::string, std::string>> versions() const override { return {}; }
  Offers offers() const override { return kAll_offers; }
};

// An I2C bus that is let go all the time, and a serial line. Its last time is the capture's end.
std::string idle_until(int end_us) {
  return "$timescale 1 us $end\n$scope module x $end\n$var wire 1 ! i2c3_scl $end\n"
         "$var wire 1 \" i2c3_sda $end\n$var wire 1 # usart1_tx $end\n$upscope $end\n"
         "$enddefinitions $end\n#0\n1!\n1\"\n1#\n#" +
         std::to_string(end_us) + "\n";
}

struct Unread {
  int port = 0;
  io::BusUnread what;
  std::int64_t end_ns = 0;
};

// Of a run of 20 ms.
std::vector<Unread> unread_with(int end_us) {
  const ScratchFolder folder;
  EXPECT_TRUE(write_text(folder.file("x.vcd"), idle_until(end_us)));
  CopperTarget target({folder.file("x.vcd"), 1e6, {}}, std::make_unique<IdleTarget>());
  const auto started = target.start();
  EXPECT_TRUE(started) << started.error().message();
  io::Batch all;
  target.run(20'000'000, {});
  EXPECT_TRUE(target.arrive(all));
  target.stop(all);
  target.stop(all);
  std::vector<Unread> unread;
  for (io::Reader r(all.bytes()); r.next();) {
    if (r.header().kind != io::Kind::bus_unread) continue;
    unread.push_back({r.header().port, r.as<io::BusUnread>(), r.header().t_ns});
  }
  return unread;
}

// What a bus did behind its end nobody saw: the firmware was blamed for its silence.
TEST(CopperTarget, ACaptureThatEndsBeforeTheRunHasNotSeenTheRest) {
  const std::vector<Unread> unread = unread_with(8'000);
  ASSERT_EQ(unread.size(), 1u);
  EXPECT_EQ(unread[0].port, 3);
  EXPECT_EQ(unread[0].what.spi, 0);
  EXPECT_GE(unread[0].what.start_ns, 7'998'000);  // two samples of 1 us
  EXPECT_LE(unread[0].what.start_ns, 8'002'000);
  EXPECT_EQ(unread[0].end_ns, 20'000'000);
}

TEST(CopperTarget, OneThatEndsWithTheRunHas) {
  EXPECT_TRUE(unread_with(20'000).empty());
  EXPECT_TRUE(unread_with(19'500).empty());
}

}  // namespace
}  // namespace whirl
