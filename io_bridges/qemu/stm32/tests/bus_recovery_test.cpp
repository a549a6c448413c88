// Freeing a stuck I2C bus by GPIO, before the alternate function is ever chosen: nine clocks on SCL,
// then a STOP, as drivers of all parts do it at their start.
#include <gtest/gtest.h>

#include "io_bridges/devices/wire_faults.hpp"
#include "io_bridges/qemu/stm32/stm32f103.hpp"
#include "io_bridges/qemu/stm32/tests/chip_bench.hpp"

namespace whirl::stm32 {
namespace {

struct PartUnderTest {
  ChipBench::Make make;
  std::uint32_t rcc_enable, enable, gpiob;
  // What makes PB10 and PB11 open-drain outputs.
  std::uint32_t configuration[2][2];
};
const PartUnderTest kParts[] = {
    {make_stm32f405, 0x40023830, 0x2, 0x40020400, {{0x04, 0xC00}, {0x00, 0x00500280}}},
    {make_stm32f103, 0x40021018, 0x8, 0x40010C00, {{0x0C, 0xC00}, {0x04, 0x44446644}}},
};
constexpr std::uint32_t kScl = 1u << 10, kSda = 1u << 11;

class Recovery {
 public:
  explicit Recovery(const PartUnderTest& part)
      : part_(part),
        bench_(8e6, part.make),
        faults_(bench_.events(), book_, *bench_.chip().i2c(2), 2) {}

  bool solder() { return bench_.chip().solder_i2c(2, "", ""); }
  void stick(int pulses) {
    book_.add({1, io::FaultKind::i2c_stuck_sda, 1000, io::kNever, 2, io::kAnywhere, 0,
               static_cast<double>(pulses)});
    bench_.run(2000);
  }
  void open_drain_outputs() {
    bench_.set_bits(part_.rcc_enable, part_.enable);
    const std::uint32_t odr = part_.make == make_stm32f405 ? 0x14 : 0x0C;
    bench_.put(part_.gpiob + odr, kScl | kSda);
    for (const auto& [offset, value] : part_.configuration) bench_.put(part_.gpiob + offset, value);
  }
  std::uint32_t levels() {
    const std::uint32_t idr = part_.make == make_stm32f405 ? 0x10 : 0x08;
    return bench_.get(part_.gpiob + idr) & (kScl | kSda);
  }
  void set(std::uint32_t pins, bool high) {
    const std::uint32_t bsrr = part_.make == make_stm32f405 ? 0x18 : 0x10;
    bench_.put(part_.gpiob + bsrr, high ? pins : pins << 16);
    bench_.run(5000);
  }
  io::I2cBus& bus() { return *bench_.chip().i2c(2); }

 private:
  const PartUnderTest& part_;
  ChipBench bench_;
  io::FaultBook book_;
  io::I2cWireFaults faults_;
};

TEST(BusRecovery, AReleasedOpenDrainPinReadsThePullUpOfTheBus) {
  for (const PartUnderTest& part : kParts) {
    Recovery r(part);
    ASSERT_TRUE(r.solder());
    r.open_drain_outputs();
    EXPECT_EQ(r.levels(), kScl | kSda);
    r.set(kSda, false);
    EXPECT_EQ(r.levels(), kScl);
    EXPECT_FALSE(r.bus().sda().level());
    r.set(kSda, true);
    EXPECT_EQ(r.levels(), kScl | kSda);
  }
}

TEST(BusRecovery, NineClocksByGpioFreeAStuckBus) {
  for (const PartUnderTest& part : kParts) {
    Recovery r(part);
    ASSERT_TRUE(r.solder());
    r.stick(9);
    r.open_drain_outputs();
    int clocks = 0;
    for (; clocks < 20 && (r.levels() & kSda) == 0; ++clocks) {
      r.set(kScl, false);
      r.set(kScl, true);
    }
    EXPECT_EQ(clocks, 9);
    r.set(kSda, false);
    r.set(kSda, true);  // STOP
    EXPECT_EQ(r.levels(), kScl | kSda);
    EXPECT_TRUE(r.bus().idle());
  }
}

}  // namespace
}  // namespace whirl::stm32
