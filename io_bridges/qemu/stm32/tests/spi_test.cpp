// SPI1 of an F405 (RM0090 chapter 28), PCLK2 84 MHz; a target behind PB0.
#include "io_bridges/qemu/stm32/spi.hpp"
#include "base/near.hpp"
#include "io_bridges/qemu/stm32/tests/chip_bench.hpp"

namespace whirl::stm32 {
namespace {

constexpr std::uint32_t kSpi = 0x40013000, kCr1 = kSpi, kCr2 = kSpi + 4, kSr = kSpi + 8,
                        kDr = kSpi + 0xC;
constexpr std::uint32_t RXNE = 1, TXE = 2, CRCERR = 16, MODF = 32, OVR = 64, BSY = 128;
constexpr std::uint32_t kMaster = 0x0344;  // SSM SSI SPE MSTR, PCLK / 2, mode 0
constexpr Nanoseconds kByte_ns = 190;      // 8 bits at 42 MHz: 190.5

struct Counter : io::SpiTarget {
  void select(bool, Nanoseconds) override {}
  std::uint8_t transfer(std::uint8_t mosi, std::uint32_t, int m, Nanoseconds now) override {
    sent.push_back(mosi);
    at.push_back(now);
    mode = m;
    return next++;
  }
  std::vector<std::uint8_t> sent;
  std::vector<Nanoseconds> at;
  std::uint8_t next = 0x80;
  int mode = -1;
};

struct SpiBench : ChipBench {
  SpiBench() {
    clock_168();
    set_bits(0x40023830, 3 | (1u << 22));
    set_bits(0x40023844, 1u << 12);
    for (int pin : {5, 6, 7}) mux('A', pin, 5);
    chip().spi(1)->add(target, *chip().pin("PB0"));
    put(0x40020418, 1u << 16);
    put(0x40020400, 0x281);
  }
  Counter target;
};

TEST(Spi, TxeRisesWhenDrMovesOnAndBsyFallsAfterTheLastBit) {
  SpiBench bench;
  bench.put(kCr1, kMaster);
  EXPECT_EQ(bench.get(kSr), TXE);
  bench.put(kDr, 1);
  EXPECT_EQ(bench.get(kSr), TXE | BSY);
  bench.put(kDr, 2);
  EXPECT_EQ(bench.get(kSr), BSY);
  bench.run(191);
  EXPECT_EQ(bench.get(kSr), TXE | BSY | RXNE);
  EXPECT_EQ(bench.get(kDr), 0x80u);
  bench.run(191);
  EXPECT_EQ(bench.get(kSr), TXE | RXNE);
  ASSERT_EQ(bench.target.at.size(), 2u);
  EXPECT_EQ(bench.target.at[1] - bench.target.at[0], kByte_ns);  // back to back
}

TEST(Spi, AnUnreadFrameIsKeptAndTheNextSetsOvr) {
  SpiBench bench;
  bench.put(kCr2, 0x20);  // ERRIE
  bench.put(kCr1, kMaster);
  bench.put(kDr, 1);
  bench.put(kDr, 2);
  bench.run(1000);
  EXPECT_EQ(bench.get(kSr), TXE | RXNE | OVR);
  EXPECT_TRUE(bench.irq(35));
  EXPECT_EQ(bench.get(kDr), 0x80u);
  EXPECT_EQ(bench.get(kSr), TXE | OVR);  // this read, after DR's, clears it
  EXPECT_EQ(bench.get(kSr), TXE);
  EXPECT_FALSE(bench.irq(35));
}

TEST(Spi, SixteenBitFramesGoHighByteFirstAndLsbFirstTurnsThemRound) {
  SpiBench bench;
  bench.put(kCr1, kMaster | 0x0800);
  bench.put(kDr, 0x1234);
  bench.run(400);
  EXPECT_EQ(bench.get(kDr), 0x8081u);
  EXPECT_EQ(bench.target.sent, (std::vector<std::uint8_t>{0x12, 0x34}));
  bench.put(kCr1, 0);
  bench.put(kCr1, kMaster | 0x80 | 3);
  bench.put(kDr, 0x01);
  bench.run(400);
  EXPECT_EQ(bench.target.sent.back(), 0x80);
  EXPECT_EQ(bench.get(kDr), 0x41u);  // 0x82 mirrored
  EXPECT_EQ(bench.target.mode, 3);
}

TEST(Spi, BaudRateIsPclkOverAPowerOfTwo) {
  for (std::uint32_t br = 0; br < 8; ++br) {
    SpiBench bench;
    bench.put(kCr1, kMaster | (br << 3));
    const Nanoseconds t = bench.now();
    bench.put(kDr, 0);
    bench.run(100'000);
    EXPECT_TRUE(near(static_cast<double>(bench.target.at[0] - t), 8.0 * (2 << br) / 84e6 * 1e9,
                     stated(0.51, "whole nanoseconds")));
  }
}

// RM0090 28.3.8: in receive-only mode the clock runs from SPE on; the frame that runs when SPE is
// cleared still ends, and no other begins.
TEST(Spi, ReceiveOnlyClocksUntilSpeIsCleared) {
  SpiBench bench;
  bench.put(kCr1, kMaster | 0x0400);
  for (int i = 0; i < 3; ++i) {
    bench.wait(kSr, RXNE, RXNE);
    if (i == 2) break;
    EXPECT_EQ(bench.get(kDr), 0x80u + static_cast<std::uint32_t>(i));
  }
  bench.put(kCr1, (kMaster | 0x0400) & ~0x40u);
  EXPECT_EQ(bench.get(kDr), 0x82u);
  bench.run(10'000);
  EXPECT_EQ(bench.get(kDr), 0x83u);
  EXPECT_EQ(bench.target.sent.size(), 4u);
}

TEST(Spi, OneLineTransmitReceivesNothing) {
  SpiBench bench;
  bench.put(kCr1, kMaster | 0xC000);  // BIDIMODE BIDIOE
  bench.put(kDr, 0x5A);
  bench.run(1000);
  EXPECT_EQ(bench.get(kSr), TXE);
  EXPECT_EQ(bench.target.sent, (std::vector<std::uint8_t>{0x5A}));
}

TEST(Spi, NssLowInAMasterIsAModeFault) {
  SpiBench bench;
  bench.put(kCr1, kMaster & ~0x0100u);  // SSM with SSI 0
  EXPECT_EQ(bench.get(kSr) & MODF, MODF);
  EXPECT_EQ(bench.get(kCr1) & 0x44, 0u);  // SPE and MSTR are gone
  bench.put(kCr1, kMaster);
  EXPECT_EQ(bench.get(kSr) & MODF, 0u);
}

TEST(Spi, SsoeHoldsNssLowWhileEnabled) {
  SpiBench bench;
  bench.mux('A', 4, 5);
  bench.put(kCr2, 4);
  bench.put(kCr1, 0x04);
  EXPECT_TRUE(bench.chip().pin("PA4")->level());
  bench.put(kCr1, 0x44);
  EXPECT_FALSE(bench.chip().pin("PA4")->level());
  bench.put(kCr1, 0x04);
  EXPECT_TRUE(bench.chip().pin("PA4")->level());
}

// CRC-8 with polynomial 7 over "123456789" is 0xF4 (the catalogue's check value).
TEST(Spi, CrcUnitAppendsTheCheckValue) {
  SpiBench bench;
  bench.put(kCr1, kMaster & ~0x40u);
  bench.put(kCr1, kMaster | 0x2000);
  for (char c : std::string("123456789")) {
    bench.wait(kSr, TXE, TXE);
    bench.put(kDr, static_cast<std::uint32_t>(c));
  }
  bench.set_bits(kCr1, 0x1000);  // CRCNEXT while the last byte is in DR
  bench.run(5000);
  EXPECT_EQ(bench.target.sent.size(), 10u);
  EXPECT_EQ(bench.target.sent.back(), 0xF4);
  EXPECT_EQ(bench.get(kSpi + 0x18), 0xF4u);
  EXPECT_EQ(bench.get(kSr) & CRCERR, CRCERR);  // the target sent no CRC
  bench.put(kSr, 0);
  EXPECT_EQ(bench.get(kSr) & CRCERR, 0u);
}

// TransmitReceive_DMA of HAL and NuttX: RX stream first, both ended by their transfer-complete.
TEST(Spi, DmaMovesFifteenBytesBothWaysBackToBack) {
  SpiBench bench;
  constexpr std::uint32_t kRx = 0x40026410, kTx = 0x40026410 + 3 * 0x18;
  for (int i = 0; i < 15; ++i)
    *bench.ram(0x20000000 + static_cast<std::uint32_t>(i)) = static_cast<std::uint8_t>(i);
  bench.put(kRx + 8, kDr);
  bench.put(kRx + 0xC, 0x20000100);
  bench.put(kRx + 4, 15);
  bench.put(kRx, (3u << 25) | (2u << 16) | (1u << 10) | (1u << 4) | 1);
  bench.put(kTx + 8, kDr);
  bench.put(kTx + 0xC, 0x20000000);
  bench.put(kTx + 4, 15);
  bench.put(kTx, (3u << 25) | (1u << 10) | (1u << 6) | 1);
  bench.put(kCr1, kMaster | (2u << 3));  // 10.5 MHz
  bench.put(kCr2, 3);
  const Nanoseconds t = bench.now();
  while (!bench.irq(56) && bench.now() - t < 1'000'000) bench.run(10);
  EXPECT_TRUE(near(static_cast<double>(bench.now() - t), 15 * 762.0,
                   stated(200.0, "the first byte's DMA, the bench's steps")));
  for (std::uint8_t i = 0; i < 15; ++i) EXPECT_EQ(*bench.ram(0x20000100u + i), 0x80 + i);
  EXPECT_EQ(bench.target.sent.size(), 15u);
  EXPECT_EQ(bench.get(kSr), TXE);
  EXPECT_EQ(bench.get(0x40026400), (3u << 4) | (3u << 26));  // HTIF, TCIF of streams 0 and 3
}

}  // namespace
}  // namespace whirl::stm32
