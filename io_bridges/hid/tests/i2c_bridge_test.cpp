#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "io_bridges/devices/esc_i2c.hpp"
#include "io_bridges/hid/plugged_bridge.hpp"
#include "io_bridges/hid/tests/bridge_bench.hpp"

namespace whirl::io {
namespace {

using Bytes = std::vector<std::uint8_t>;

class Bridges : public ::testing::TestWithParam<BridgeKind> {
 protected:
  Bridges() : bench(GetParam()) {
    auto opened = bench.open();
    if (opened) bridge = std::move(opened.value());
  }
  void SetUp() override { ASSERT_NE(bridge, nullptr); }
  bool is_mcp() const { return GetParam() == BridgeKind::mcp2221a; }

  BridgeBench bench;
  std::unique_ptr<I2cBridge> bridge;
};
INSTANTIATE_TEST_SUITE_P(Kinds, Bridges,
                         ::testing::Values(BridgeKind::mcp2221a, BridgeKind::cp2112),
                         [](const auto& of) {
                           return of.param == BridgeKind::mcp2221a ? "Mcp2221" : "Cp2112";
                         });

TEST_P(Bridges, WhatIsWrittenIsReadBackAfterARepeatedStart) {
  ASSERT_TRUE(bridge->write(0x50, Bytes{0x10, 1, 2, 3}).ok());
  const int stops = bench.registers.stops;
  const I2cTransfer back = bridge->transfer(0x50, Bytes{0x10}, 3);
  EXPECT_EQ(back.outcome, I2cOutcome::done);
  EXPECT_EQ(back.bytes, (Bytes{1, 2, 3}));
  EXPECT_EQ(bench.registers.stops, stops + 1);  // none between the pointer and the data
}

TEST_P(Bridges, LongTransfersComeWholeInSeveralReports) {
  std::iota(bench.registers.content.begin(), bench.registers.content.end(), std::uint8_t{0});
  const I2cTransfer all = bridge->transfer(0x50, Bytes{0x00}, 200);
  ASSERT_TRUE(all.ok()) << all.error("all").message();
  Bytes want(200);
  std::iota(want.begin(), want.end(), std::uint8_t{0});
  EXPECT_EQ(all.bytes, want);
  Bytes out(is_mcp() ? 201 : 61, 0xA5);
  out[0] = 0x20;
  ASSERT_TRUE(bridge->write(0x50, out).ok());
  EXPECT_EQ(bench.registers.content[0x20 + out.size() - 2], 0xA5);
  EXPECT_EQ(bench.registers.pointer, static_cast<std::uint8_t>(0x20 + out.size() - 1));
}

TEST_P(Bridges, NobodyThereAndARefusedByteAreToldApartAndHarmNothingAfter) {
  EXPECT_EQ(bridge->write(0x51, Bytes{1, 2}).outcome, I2cOutcome::address_nack);
  EXPECT_EQ(bridge->read(0x51, 2).outcome, I2cOutcome::address_nack);
  EXPECT_EQ(bridge->transfer(0x51, Bytes{1}, 2).outcome, I2cOutcome::address_nack);
  bench.registers.refuses = 0x12;
  EXPECT_EQ(bridge->write(0x50, Bytes{0x10, 1, 2, 3, 4}).outcome, I2cOutcome::data_nack);
  EXPECT_EQ(bench.registers.content[0x11], 2);
  bench.registers.refuses = 256;
  EXPECT_TRUE(bridge->write(0x50, Bytes{0x10, 7}).ok());
  EXPECT_EQ(bench.registers.content[0x10], 7);
}

TEST_P(Bridges, ALineThatStaysLowIsABusThatIsStuckUntilItIsLetGo) {
  for (Wire* wire : {&bench.bus.sda(), &bench.bus.scl()}) {
    wire->force(Drive::low, bench.queue.now());
    EXPECT_EQ(bridge->write(0x50, Bytes{0x10, 1}).outcome, I2cOutcome::bus_stuck) << wire->name();
    wire->force(Drive::none, bench.queue.now());
    EXPECT_TRUE(bridge->write(0x50, Bytes{0x10, 1}).ok()) << wire->name();
  }
}

TEST_P(Bridges, ScanFindsWhoAnswers) {
  EscI2c esc(0x29);
  bench.bus.add(esc);
  const auto found = bridge->scan();
  ASSERT_TRUE(found.ok()) << found.error().message();
  EXPECT_EQ(found.value(), (Bytes{0x29, 0x50}));
}

TEST_P(Bridges, TheBusIsNeverFasterThanAskedForAndTransfersAreStamped) {
  for (const int speed_Hz : {400'000, 100'000, 50'000}) {
    ASSERT_TRUE(bridge->set_speed(speed_Hz).ok());
    I2cTransaction seen;
    bench.bus.on_transaction([&](const I2cTransaction& t) { seen = t; });
    const I2cTransfer transfer = bridge->write(0x50, Bytes(33, 0));
    ASSERT_TRUE(transfer.ok());
    const double bits = 9.0 * 34 + 1;  // with the address and the STOP
    EXPECT_GE(static_cast<double>(seen.stop_ns - seen.start_ns),
              bits * 1e9 / speed_Hz - bits);  // whole nanoseconds
    EXPECT_LT(static_cast<double>(seen.stop_ns - seen.start_ns), bits * 1.05e9 / speed_Hz);
    EXPECT_LE(transfer.begin_ns, seen.start_ns);
    EXPECT_GE(transfer.end_ns, seen.stop_ns);
  }
  EXPECT_FALSE(bridge->set_speed(1'000'000).ok());
  EXPECT_FALSE(bridge->set_speed(1'000).ok());
}

TEST_P(Bridges, ABridgeThatDoesNotAnswerEndsInTime) {
  bench.cable.late_ns = 10'000'000'000;
  const I2cTransfer lost = bridge->write(0x50, Bytes{0x10, 1});
  EXPECT_EQ(lost.outcome, I2cOutcome::timed_out);
  EXPECT_LT(lost.end_ns - lost.begin_ns, 5'000'000'000);
  bench.cable.late_ns = 0;
  bench.registers.content[0x30] = 0x77;
  const I2cTransfer next =
      bridge->transfer(0x50, Bytes{0x30}, 1);  // no late answer is taken for its own
  ASSERT_TRUE(next.ok()) << next.error("next").message();
  EXPECT_EQ(next.bytes, Bytes{0x77});
}

// Pulled after each number of reports that a transfer has: that one is told, the next ones run.
TEST_P(Bridges, UnplugInTheMiddleLosesThatTransferOnly) {
  PluggedBridge plugged(
      [&] {
        return bench.cable.plugged ? bench.open() : Result<std::unique_ptr<I2cBridge>>(Error{});
      },
      [&] { return bench.queue.now(); });
  ASSERT_TRUE(plugged.transfer(0x50, Bytes{0x10, 0}, 0).ok());
  for (int left = 0; left < 2; ++left) {
    bench.cable.reports_left = left;
    const I2cTransfer cut = plugged.transfer(0x50, Bytes{0x10, 9}, 0);
    EXPECT_EQ(cut.outcome, I2cOutcome::unplugged);
    EXPECT_EQ(cut.error("bridge").kind, ErrorKind::host);
    EXPECT_FALSE(plugged.plugged());
    EXPECT_EQ(plugged.transfer(0x50, Bytes{0x10, 9}, 0).outcome, I2cOutcome::unplugged);
    bench.cable.plugged = true;
    bench.cable.reports_left = -1;
    bench.queue.run_until(bench.queue.now() + 200'000'000);
    for (std::uint8_t i = 0; i < 10; ++i)
      ASSERT_TRUE(plugged.transfer(0x50, Bytes{0x10, i}, 0).ok());
    EXPECT_EQ(bench.registers.content[0x10], 9);
  }
  EXPECT_EQ(plugged.times_opened(), 3u);
}

TEST_P(Bridges, AnEscTakesSetpointsAndGivesItsStatus) {
  EscI2c esc(0x29);
  bench.bus.add(esc);
  esc.on_setpoint([&](const EscI2c::Write& write) {
    esc.set_status({1.0, 2.0 * write.v, EscFlag::kArmed});
  });
  for (std::uint16_t v = 0; v <= kEscMaxSetpoint; v += 89) {
    ASSERT_TRUE(bridge->write(0x29, pack_setpoint(0x29, v)).ok());
    const I2cTransfer read = bridge->read(0x29, 6);
    ASSERT_TRUE(read.ok());
    const auto status = unpack_status(0x29, read.bytes);
    ASSERT_TRUE(status.has_value());
    EXPECT_EQ(status->speed_rpm, 2.0 * v);
    EXPECT_EQ(status->flags, EscFlag::kArmed);
  }
  EXPECT_EQ(esc.rejected(), 0u);
}

TEST(Cp2112, TellsLostArbitrationAndTheLimitsOfItsRequests) {
  BridgeBench bench(BridgeKind::cp2112);
  auto bridge = bench.open();
  ASSERT_TRUE(bridge.ok());
  bench.engine().lose_next();
  EXPECT_EQ(bridge.value()->write(0x50, Bytes{1}).outcome, I2cOutcome::lost_arbitration);
  EXPECT_EQ(bridge.value()->write(0x50, Bytes(62)).outcome, I2cOutcome::refused);
  EXPECT_EQ(bridge.value()->transfer(0x50, Bytes(17), 1).outcome, I2cOutcome::refused);
  EXPECT_EQ(bridge.value()->read(0x50, 513).outcome, I2cOutcome::refused);
  EXPECT_EQ(bridge.value()->read(0x50, 512).bytes.size(), 512u);
}

TEST(Mcp2221, AChipLeftInTheMiddleOfATransferIsBroughtBackAtOpening) {
  BridgeBench bench(BridgeKind::mcp2221a);
  bench.chip->output(
      HidReport{0, 0x90, 3, 0, 0x51 << 1, 1, 2, 3});  // nobody there: it stays in 0x25
  bench.queue.run_until(10'000'000);
  bench.chip->take_input();
  auto bridge = bench.open();
  ASSERT_TRUE(bridge.ok());
  EXPECT_TRUE(bridge.value()->write(0x50, Bytes{0x10, 1}).ok());
}

// EasyMCP2221: a cancel before the first transfer hangs the engine in 0x62. Our master sends none.
TEST(Mcp2221Chip, HangsOnACancelBeforeItsFirstTransferUntilAReset) {
  BridgeBench bench(BridgeKind::mcp2221a);
  const auto state = [&](const HidReport& request) {
    bench.chip->output(request);
    return bench.chip->take_input()[8];
  };
  EXPECT_EQ(state({0, 0x10}), 0x00);
  EXPECT_EQ(state({0, 0x10, 0, 0x10}), 0x62);
  bench.chip->output(HidReport{0, 0x70, 0xAB, 0xCD, 0xEF});
  EXPECT_EQ(state({0, 0x10}), 0x00);  // a short report, filled with zeros
}

}  // namespace
}  // namespace whirl::io
