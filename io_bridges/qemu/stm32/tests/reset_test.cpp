// A reset in the middle of everything: transfers end, lines rise, registers forget.
#include "io_bridges/qemu/stm32/tests/i2c_bench.hpp"

namespace whirl::stm32 {
namespace {

TEST(Reset, InTheMiddleOfTransfersLeavesAQuietPart) {
  I2cBench bench;
  constexpr std::uint32_t kSpi = 0x40013000, kStream = 0x40026410;
  bench.point_at(0x10);  // I2C1: a byte is under way
  bench.set_bits(0x40023844, 1u << 12);
  bench.set_bits(0x40023830, 1u << 22);
  bench.put(kSpi, 0x037C);  // slowest clock
  bench.put(kSpi + 0xC, 1);
  bench.put(kStream + 4, 60'000);
  bench.put(kStream + 8, 0x20000000);
  bench.put(kStream + 0xC, 0x20001000);
  bench.put(kStream, (2u << 6) | (1u << 4) | 1);
  bench.run(5'000);
  bench.chip().reset(ResetCause::software);
  EXPECT_TRUE(bench.bus().idle());
  EXPECT_EQ(bench.chip().sysclk_Hz(), 16e6);
  bench.run(50'000'000);
  for (int irq = 0; irq < 82; ++irq) EXPECT_FALSE(bench.irq(irq)) << irq;
  bench.set_bits(0x40023844, 1u << 12);
  bench.set_bits(0x40023840, 1u << 21);
  bench.set_bits(0x40023830, 1u << 22);
  EXPECT_EQ(bench.get(kSpi + 8), 2u);
  EXPECT_EQ(bench.get(kCr1), 0u);
  EXPECT_EQ(bench.get(kSr1), 0u);
  EXPECT_EQ(bench.get(kStream), 0u);
  EXPECT_EQ(bench.get(kStream + 4), 0u);
}

// The same firmware twice gives the same times: nothing of the first life is left.
TEST(Reset, TheSecondLifeRunsAsTheFirst) {
  I2cBench bench;
  const auto life = [&] {
    const Nanoseconds t = bench.now();
    bench.clock_168();
    bench.set_bits(0x40023840, 1u << 21);
    bench.mux('B', 8, 4, true);
    bench.mux('B', 9, 4, true);
    bench.put(kCr2, 42);
    bench.put(kCcr, 0x8000 | 35);
    bench.put(kCr1, 1);
    bench.point_at(0x20);
    bench.wait(kSr1, BTF, BTF);
    return bench.now() - t;
  };
  bench.chip().reset(ResetCause::power_on);
  const Nanoseconds first = life();
  bench.chip().reset(ResetCause::power_on);
  EXPECT_EQ(life(), first);
}

}  // namespace
}  // namespace whirl::stm32
