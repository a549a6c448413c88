// DMA2 of an F405 (RM0090 chapter 10): memory to memory, FIFO, double buffer, priorities, errors.
#include "io_bridges/qemu/stm32/dma.hpp"
#include "base/near.hpp"
#include "io_bridges/qemu/stm32/tests/chip_bench.hpp"

namespace whirl::stm32 {
namespace {

constexpr std::uint32_t kDma = 0x40026400, kLisr = kDma, kLifcr = kDma + 8;
constexpr std::uint32_t TEIF = 8, HTIF = 16, TCIF = 32;

std::uint32_t stream(int n) {
  return kDma + 0x10 + 0x18 * static_cast<std::uint32_t>(n);
}

// Requests whose data register is a word of RAM: the tests pull them one item at a time.
struct DmaBench : ChipBench {
  DmaBench() {
    set_bits(0x40023830, 1u << 22);
    for (std::uint32_t i = 0; i < 256; ++i) *ram(0x20000000 + i) = static_cast<std::uint8_t>(i);
  }
  void set_up(int n, std::uint32_t cr, std::uint32_t from, std::uint32_t to, std::uint32_t count,
              std::uint32_t fcr = 0x21) {
    put(stream(n) + 8, from);
    put(stream(n) + 0xC, to);
    put(stream(n) + 4, count);
    put(stream(n) + 0x14, fcr);
    put(stream(n), cr | 1);
  }
};
constexpr std::uint32_t kMemToMem = 2u << 6, kPinc = 1u << 9, kMinc = 1u << 10;

TEST(Dma, MemoryToMemoryCopiesAndStops) {
  DmaBench bench;
  bench.set_up(1, kMemToMem | kPinc | kMinc | (1u << 4), 0x20000000, 0x20001000, 100, 7);
  bench.run(1'000'000);
  EXPECT_EQ(std::memcmp(bench.ram(0x20000000), bench.ram(0x20001000), 100), 0);
  EXPECT_EQ(*bench.ram(0x20001064), 0);
  EXPECT_EQ(bench.get(stream(1)) & 1, 0u);
  EXPECT_EQ(bench.get(stream(1) + 4), 0u);
  EXPECT_EQ(bench.get(kLisr), (TCIF | HTIF) << 6);
  EXPECT_TRUE(bench.irq(57));
  bench.put(kLifcr, 0x3D << 6);
  EXPECT_FALSE(bench.irq(57));
  EXPECT_EQ(bench.get(kLisr), 0u);
}

// RM0090 2.1: a transfer takes the bus matrix a cycle, and the bridge to APB1 two of PCLK1 (16 MHz here).
TEST(Dma, HoldsTheCoreUpForNoLongerThanItsTransfersTake) {
  constexpr std::uint32_t kTim2Arr = 0x4000002C;
  DmaBench bench;
  EXPECT_EQ(bench.chip().core_waits_for_dma_at_most_ns(), 0.0);
  bench.set_up(1, kMemToMem | kPinc | kMinc, 0x20000000, 0x20001000, 100, 0);
  bench.run(1'000'000);
  EXPECT_TRUE(near(bench.chip().core_waits_for_dma_at_most_ns(), 200 * 62.5,
                   stated(1.0, "whole nanoseconds")));
  bench.set_bits(0x40023840, 1);
  bench.put(kLifcr, 0x3D << 6);
  bench.set_up(1, kMemToMem | (2u << 11) | (2u << 13), 0x20000000, kTim2Arr, 10, 0);
  bench.run(1'000'000);
  EXPECT_TRUE(near(bench.chip().core_waits_for_dma_at_most_ns(), 200 * 62.5 + 10 * (62.5 + 187.5),
                   stated(1.0, "whole nanoseconds")));
}

TEST(Dma, FifoPacksBytesIntoWordsAndUnpacksThem) {
  DmaBench bench;
  // 16 items of 1 byte to 4 words; then 8 items of 4 bytes to 32 bytes.
  bench.set_up(0, kMemToMem | kPinc | kMinc | (2u << 13), 0x20000000, 0x20001000, 16, 7);
  bench.run(1'000'000);
  EXPECT_EQ(std::memcmp(bench.ram(0x20000000), bench.ram(0x20001000), 16), 0);
  bench.put(kLifcr, 0x3D);
  bench.set_up(0, kMemToMem | kPinc | kMinc | (2u << 11), 0x20000040, 0x20001100, 8, 7);
  bench.run(1'000'000);
  EXPECT_EQ(std::memcmp(bench.ram(0x20000040), bench.ram(0x20001100), 32), 0);
}

// 7 bytes do not fill two words: the rest is flushed as it is, and nothing beyond it is touched.
TEST(Dma, AnOddRestIsFlushedAtTheEnd) {
  DmaBench bench;
  std::memset(bench.ram(0x20001000), 0xEE, 8);
  bench.set_up(0, kMemToMem | kPinc | kMinc | (1u << 13), 0x20000001, 0x20001000, 7, 7);
  bench.run(1'000'000);
  EXPECT_EQ(std::memcmp(bench.ram(0x20000001), bench.ram(0x20001000), 7), 0);
  EXPECT_EQ(*bench.ram(0x20001007), 0xEE);
}

TEST(Dma, CcmAndHolesAreTransferErrors) {
  for (const std::uint32_t bad : {0x10000000u, 0x30000000u}) {
    DmaBench bench;
    bench.set_up(2, kMemToMem | kPinc | kMinc | (1u << 2), bad, 0x20001000, 4, 7);
    bench.run(1'000'000);
    EXPECT_EQ(bench.get(kLisr), TEIF << 16);
    EXPECT_TRUE(bench.irq(58));
    EXPECT_EQ(bench.get(stream(2)) & 1, 0u);
  }
}

// The UART transmitter as a slow request: 1 item each 10 bit times.
struct PacedBench : DmaBench {
  PacedBench() {
    set_bits(0x40023844, 1u << 4);
    mux('A', 9, 7);
    put(0x40011008, 16);  // 1 Mbaud at 16 MHz
    put(0x4001100C, 0x2008);
    run(100'000);
    put(0x40011014, 0x80);
  }
  static constexpr std::uint32_t kDr = 0x40011004, kToUart = (4u << 25) | (1u << 6) | kMinc;
  void set_up_uart(std::uint32_t cr, std::uint32_t count) {
    put(stream(7) + 8, kDr);
    put(stream(7) + 0xC, 0x20000000);
    put(stream(7) + 4, count);
    put(stream(7), kToUart | cr | 1);
  }
};

TEST(Dma, NdtrCountsDownWithTheRequestsAndHtComesAtHalf) {
  PacedBench bench;
  bench.set_up_uart(1u << 3, 10);  // HTIE
  bench.run(5'000);
  EXPECT_EQ(bench.get(stream(7) + 4), 8u);  // one in the shift register, one in DR
  EXPECT_FALSE(bench.irq(70));
  bench.run(30'000);
  EXPECT_EQ(bench.get(stream(7) + 4), 5u);
  EXPECT_TRUE(bench.irq(70));
  EXPECT_EQ(bench.get(kDma + 4), HTIF << 22);
}

TEST(Dma, SettingsAreLockedWhileEnabled) {
  PacedBench bench;
  bench.set_up_uart(0, 10);
  const std::uint32_t cr = bench.get(stream(7));
  bench.put(stream(7), cr ^ (3u << 16) ^ (1u << 10) ^ (1u << 4));
  bench.put(stream(7) + 4, 99);
  bench.put(stream(7) + 8, 0);
  EXPECT_EQ(bench.get(stream(7)), cr ^ (1u << 4));  // interrupt enables alone may change
  EXPECT_LE(bench.get(stream(7) + 4), 10u);
  EXPECT_EQ(bench.get(stream(7) + 8), bench.kDr);
}

// HAL_DMA_Abort_IT relies on it: EN cleared by software ends with TCIF.
TEST(Dma, ClearingEnStopsAndRaisesTcif) {
  PacedBench bench;
  bench.set_up_uart(1u << 4, 10);
  bench.run(15'000);
  bench.clear_bits(stream(7), 1);
  EXPECT_TRUE(bench.irq(70));
  const std::uint32_t left = bench.get(stream(7) + 4);
  bench.run(1'000'000);
  EXPECT_EQ(bench.get(stream(7) + 4), left);
}

TEST(Dma, DoubleBufferSwapsTargetsAndLetsTheIdleOneBeReplaced) {
  PacedBench bench;
  bench.put(stream(7) + 0x10, 0x20000010);
  bench.set_up_uart((1u << 18) | (1u << 4), 4);
  EXPECT_EQ(bench.get(stream(7)) & (1u << 19), 0u);
  while (!bench.irq(70)) bench.run(100);
  EXPECT_EQ(bench.get(stream(7)) & (1u << 19), 1u << 19);  // now at M1
  bench.put(stream(7) + 0x10, 0);
  EXPECT_EQ(bench.get(stream(7) + 0x10), 0x20000010u);  // in use: refused
  bench.put(stream(7) + 0xC, 0x20000020);
  EXPECT_EQ(bench.get(stream(7) + 0xC), 0x20000020u);
  EXPECT_EQ(bench.get(stream(7)) & 1, 1u);
}

TEST(Dma, TheHigherPriorityIsServedFirstThenTheLowerNumber) {
  DmaBench bench;
  bench.put(stream(0) + 8, 0x20000000);  // all three start at once and want the bus
  bench.set_up(0, kMemToMem | kPinc | kMinc, 0x20000000, 0x20001000, 50, 7);
  bench.set_up(3, kMemToMem | kPinc | kMinc | (3u << 16), 0x20000000, 0x20002000, 50, 7);
  bench.set_up(1, kMemToMem | kPinc | kMinc, 0x20000000, 0x20003000, 50, 7);
  while ((bench.get(kLisr) & (TCIF << 22)) == 0) bench.run(10);
  EXPECT_GT(bench.get(stream(0) + 4), 34u);  // at most the rest of one burst of 16
  EXPECT_EQ(bench.get(stream(1) + 4), 50u);
  while ((bench.get(kLisr) & TCIF) == 0) bench.run(10);
  EXPECT_GT(bench.get(stream(1) + 4), 34u);
}

TEST(Dma, MemoryToMemoryIsForDma2Only) {
  ChipBench bench;
  bench.set_bits(0x40023830, 1u << 21);
  bench.put(0x40026014, 4);
  bench.put(0x40026010, kMemToMem | 1);
  EXPECT_EQ(bench.get(0x40026000), TEIF);
  ASSERT_EQ(bench.findings.size(), 1u);
}

}  // namespace
}  // namespace whirl::stm32
