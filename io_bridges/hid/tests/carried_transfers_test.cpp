// A played MCP2221A whose bus is elsewhere: its client sees whole transfers that take their time.
#include <gtest/gtest.h>

#include <vector>

#include "io_bridges/hid/emulated/mcp2221_chip.hpp"
#include "io_bridges/hid/emulated/memory_hid_port.hpp"
#include "io_bridges/hid/plugged_bridge.hpp"

namespace whirl::io {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Elsewhere final : I2cCarrier {  // answers `after_ns` later
  explicit Elsewhere(EventQueue& events) : queue(events) {}
  struct Asked {
    std::uint8_t address;
    Bytes write;
    std::size_t read;
  };
  void begin(std::uint8_t address, Bytes write, std::size_t read) override {
    asked.push_back({address, std::move(write), read});
    due_ns = queue.now() + after_ns;
    open = true;
  }
  std::optional<CarriedOutcome> outcome() override {
    if (!open || queue.now() < due_ns) return std::nullopt;
    open = false;
    CarriedOutcome made{asked.back().address == 0x29, times_out, {}};
    for (std::size_t n = 0; n < asked.back().read; ++n) {
      made.bytes.push_back(static_cast<std::uint8_t>(n + 1));
    }
    return made;
  }
  void abandon() override { open = false; }

  EventQueue& queue;
  Nanoseconds after_ns = 3'000'000, due_ns = 0;
  bool open = false, times_out = false;
  std::vector<Asked> asked;
};

struct CarriedRig {
  CarriedRig() {
    auto opened = start_i2c_bridge(BridgeKind::mcp2221a,
                                   std::make_unique<MemoryHidPort>(queue, chip, cable), {});
    EXPECT_TRUE(opened.ok());
    bridge = std::move(opened.value());
  }
  EventQueue queue;
  Elsewhere bus{queue};
  Mcp2221Chip chip{queue, bus, "A1"};
  HidCable cable;
  std::unique_ptr<I2cBridge> bridge;
};

TEST(CarriedTransfers, AWriteGoesAsAWholeAndIsDoneWhenItIs) {
  CarriedRig rig;
  const Nanoseconds begin_ns = rig.queue.now();
  EXPECT_EQ(rig.bridge->write(0x29, Bytes{1, 2, 3}).outcome, I2cOutcome::done);
  EXPECT_GE(rig.queue.now() - begin_ns, 3'000'000);
  ASSERT_EQ(rig.bus.asked.size(), 1u);
  EXPECT_EQ(rig.bus.asked[0].address, 0x29);
  EXPECT_EQ(rig.bus.asked[0].write, (Bytes{1, 2, 3}));
}

TEST(CarriedTransfers, AReadAndAWriteWithOneBehindItAreOneTransferEach) {
  CarriedRig rig;
  EXPECT_EQ(rig.bridge->read(0x29, 6).bytes, (Bytes{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(rig.bridge->transfer(0x29, Bytes{7}, 2).bytes, (Bytes{1, 2}));
  ASSERT_EQ(rig.bus.asked.size(), 2u);
  EXPECT_EQ(rig.bus.asked[1].write, Bytes{7});
  EXPECT_EQ(rig.bus.asked[1].read, 2u);
}

TEST(CarriedTransfers, NobodyThereAndNoAnswerHarmNothingAfter) {
  CarriedRig rig;
  EXPECT_EQ(rig.bridge->write(0x30, Bytes{1}).outcome, I2cOutcome::address_nack);
  EXPECT_EQ(rig.bridge->read(0x30, 2).outcome, I2cOutcome::address_nack);
  rig.bus.after_ns = 3'600'000'000'000;
  EXPECT_FALSE(rig.bridge->read(0x29, 2).ok());
  rig.bus.after_ns = 1'000'000;
  EXPECT_EQ(rig.bridge->read(0x29, 2).bytes, (Bytes{1, 2}));
}

}  // namespace
}  // namespace whirl::io
