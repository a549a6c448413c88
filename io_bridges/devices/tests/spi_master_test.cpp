#include "io_bridges/devices/spi_master.hpp"

#include <gtest/gtest.h>

namespace whirl::io {
namespace {

struct Recorder final : SpiSlave {
  explicit Recorder(EventQueue& q) : queue(q) {}
  Nanoseconds shift_out(Nanoseconds now) override {
    EXPECT_EQ(now, queue.now());
    out_ns.push_back(now);
    return 7;
  }
  std::uint8_t sampled(std::uint8_t mosi, int bits, Nanoseconds now) override {
    EXPECT_EQ(bits, 8);
    in_ns.push_back(now);
    seen.push_back(mosi);
    return static_cast<std::uint8_t>(0xA0 + seen.size());
  }
  int mode() const override { return 0; }
  EventQueue& queue;
  std::vector<Nanoseconds> out_ns, in_ns;
  std::vector<std::uint8_t> seen;
};

struct MasterBench {
  explicit MasterBench(int mode) : master(queue, slave, select, mode) {
    select.watch([this](bool, Nanoseconds now) { select_ns.push_back(now); });
  }
  SpiReply run(std::vector<std::uint8_t> bytes) {
    SpiReply reply;
    master.transfer({std::move(bytes), 1e6, 300, 400}, [&](const SpiReply& r) { reply = r; });
    queue.run_until(queue.now() + 100'000);
    return reply;
  }
  EventQueue queue;
  Recorder slave{queue};
  Wire select{"NSS"};
  std::vector<Nanoseconds> select_ns;
  SpiMaster master;
};

using Times = std::vector<Nanoseconds>;

TEST(SpiMaster, Mode3PutsBitsOutAtTheFirstEdgeAndSamplesHalfAClockBeforeTheEnd) {
  MasterBench bench(3);
  const SpiReply reply = bench.run({0x11, 0x22});
  EXPECT_EQ(bench.slave.out_ns, (Times{300, 8300}));
  EXPECT_EQ(bench.slave.in_ns, (Times{7800, 15800}));
  EXPECT_EQ(bench.select_ns, (Times{0, 16700}));
  EXPECT_EQ(bench.slave.seen, (std::vector<std::uint8_t>{0x11, 0x22}));
  EXPECT_EQ(reply.miso, (std::vector<std::uint8_t>{0xA1, 0xA2}));
  EXPECT_EQ(reply.waited_ns, (Times{7, 7}));
  EXPECT_EQ(reply.stop_ns, 16700);
  EXPECT_FALSE(bench.master.busy());
}

TEST(SpiMaster, Mode0PutsTheFirstBitOutWithChipSelectAndOneByteTooMany) {
  MasterBench bench(0);
  const SpiReply reply = bench.run({0x11, 0x22});
  EXPECT_EQ(bench.slave.out_ns, (Times{0, 7800, 15800}));
  EXPECT_EQ(bench.slave.in_ns, (Times{7300, 15300}));
  EXPECT_EQ(reply.waited_ns.size(), 2u);
}

}  // namespace
}  // namespace whirl::io
