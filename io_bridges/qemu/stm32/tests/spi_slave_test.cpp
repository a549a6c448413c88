// SPI1 of an F405 as a slave, in register terms: an external master's edges on one side, DR and SR on
// the other (RM0090 28.3, 28.5; AN5543 on the block without a FIFO).
#include "io_bridges/qemu/stm32/tests/chip_bench.hpp"

namespace whirl::stm32 {
namespace {

constexpr std::uint32_t kSpi = 0x40013000, kCr1 = kSpi, kCr2 = kSpi + 4, kSr = kSpi + 8,
                        kDr = kSpi + 0xC;
constexpr std::uint32_t RXNE = 1, TXE = 2, OVR = 64, BSY = 128;
constexpr std::uint32_t SPE = 1u << 6, kMode3 = 3, TXDMAEN = 2;

struct SlaveBench : ChipBench {
  SlaveBench() {
    clock_168();
    set_bits(0x40023830, 3 | (1u << 22));  // GPIOA, GPIOB, DMA2
    set_bits(0x40023844, 1u << 12);        // SPI1
    for (int pin : {4, 5, 6, 7}) mux('A', pin, 5);
    nss_driver = chip().pin("PA4")->add_driver("master");
    select(false);
    put(kCr1, SPE | kMode3);
  }
  void select(bool on) {
    chip().pin("PA4")->drive(nss_driver, on ? io::Drive::low : io::Drive::high, 0);
  }
  io::SpiSlave& slave() { return *chip().spi_slave(1); }
  // A whole byte of mode 3.
  std::uint32_t clock(std::uint8_t mosi, int bits = 8) {
    slave().shift_out(0);
    return slave().sampled(mosi, bits, 0);
  }
  int nss_driver = 0;
};

TEST(SpiSlave, AnswersOnlyWhileNssIsLow) {
  SlaveBench bench;
  bench.put(kDr, 0x3C);
  EXPECT_EQ(bench.clock(0x99), 0xFFu);
  EXPECT_EQ(bench.get(kSr), 0u);  // what was written waits: TXE is low
  bench.select(true);
  EXPECT_EQ(bench.clock(0x99), 0x3Cu);
  EXPECT_EQ(bench.get(kSr), RXNE | TXE);
  EXPECT_EQ(bench.get(kDr), 0x99u);
}

TEST(SpiSlave, DrMovesOnAtTheFirstBitNotAtTheLast) {
  SlaveBench bench;
  bench.select(true);
  bench.put(kDr, 0x11);
  bench.slave().shift_out(0);
  EXPECT_EQ(bench.get(kSr), TXE | BSY);
  bench.put(kDr, 0x22);  // one byte ahead, while 0x11 is on the wire
  EXPECT_EQ(bench.get(kSr), BSY);
  EXPECT_EQ(bench.slave().sampled(0xA1, 8, 0), 0x11u);
  EXPECT_EQ(bench.get(kSr), RXNE);  // between bytes BSY is low
  EXPECT_EQ(bench.get(kDr), 0xA1u);
  EXPECT_EQ(bench.clock(0xA2), 0x22u);
}

TEST(SpiSlave, TellsTheMastersModelHowLongAByteHasWaited) {
  SlaveBench bench;
  bench.select(true);
  bench.put(kDr, 0x11);
  bench.run(500);
  EXPECT_EQ(bench.slave().shift_out(bench.now()), 500);
  bench.slave().sampled(0, 8, bench.now());
  EXPECT_EQ(bench.slave().shift_out(bench.now()), io::SpiSlave::kNothing);
}

TEST(SpiSlave, AWriteBeforeTheFirstBitReplacesWhatWaits) {
  SlaveBench bench;
  bench.select(true);
  bench.put(kDr, 0x11);
  bench.put(kDr, 0x12);
  EXPECT_EQ(bench.clock(0), 0x12u);
}

TEST(SpiSlave, AWriteAfterTheFirstBitComesAByteLate) {
  SlaveBench bench;
  bench.select(true);
  bench.put(kDr, 0x11);
  bench.slave().shift_out(0);
  bench.put(kDr, 0x12);
  EXPECT_EQ(bench.slave().sampled(0, 8, 0), 0x11u);
  EXPECT_EQ(bench.clock(0), 0x12u);
}

TEST(SpiSlave, WhatWaitsWhenNssRisesBeginsTheNextTransfer) {
  SlaveBench bench;
  bench.select(true);
  bench.put(kDr, 0x11);
  bench.slave().shift_out(0);
  bench.put(kDr, 0x22);
  bench.slave().sampled(0, 8, 0);
  bench.select(false);
  bench.select(true);
  EXPECT_EQ(bench.clock(0), 0x22u);  // the residue of the prefetch
}

TEST(SpiSlave, AnUnreadByteIsKeptAndTheNextSetsOvr) {
  SlaveBench bench;
  bench.select(true);
  bench.put(kDr, 0);
  bench.clock(0x51);
  bench.put(kDr, 0);
  bench.clock(0x52);
  EXPECT_EQ(bench.get(kSr) & OVR, OVR);
  EXPECT_EQ(bench.get(kDr), 0x51u);
  bench.get(kSr);  // DR, then SR: OVR is cleared
  EXPECT_EQ(bench.get(kSr) & (OVR | RXNE), 0u);
}

TEST(SpiSlave, AnEmptyDrSendsItsLastContentAndIsAFinding) {
  SlaveBench bench;
  bench.select(true);
  bench.put(kDr, 0x77);
  EXPECT_EQ(bench.clock(0), 0x77u);
  EXPECT_TRUE(bench.findings.empty());
  EXPECT_EQ(bench.clock(0), 0x77u);
  ASSERT_EQ(bench.findings.size(), 1u);
  EXPECT_NE(bench.findings[0].find("nothing in DR"), std::string::npos);
}

TEST(SpiSlave, ABrokenByteLeavesTheBitCounterShiftedUntilSpeIsCleared) {
  SlaveBench bench;
  bench.select(true);
  bench.put(kDr, 0xF0);
  EXPECT_EQ(bench.clock(0x5, 3), 0x7u);  // 111 of 11110000, MOSI 101
  EXPECT_EQ(bench.get(kSr) & RXNE, 0u);
  bench.select(false);
  bench.select(true);
  bench.put(kDr, 0xAA);
  // Five bits more end the first byte, three begin the next: 10000 and 101.
  EXPECT_EQ(bench.clock(0xFF), 0x85u);
  EXPECT_EQ(bench.get(kDr), 0xBFu);  // 101 11111
  bench.put(kCr1, kMode3);
  bench.put(kCr1, SPE | kMode3);
  bench.put(kDr, 0x42);
  EXPECT_EQ(bench.clock(0x24), 0x42u);
  EXPECT_EQ(bench.get(kDr), 0x24u);
}

TEST(SpiSlave, EnabledInsideAByteItLosesThatByteAndSaysSo) {
  SlaveBench bench;
  bench.put(kCr1, kMode3);
  bench.select(true);
  bench.slave().shift_out(0);
  bench.put(kDr, 0x42);
  bench.put(kCr1, SPE | kMode3);
  EXPECT_EQ(bench.slave().sampled(0, 8, 0), 0xFFu);
  EXPECT_EQ(bench.findings.size(), 1u);
}

TEST(SpiSlave, InMode0TheFirstBitIsOutWithNssAndTheNextByteWithTheLastEdge) {
  SlaveBench bench;
  bench.put(kCr1, SPE);
  bench.put(kDr, 0x61);
  bench.select(true);
  bench.slave().shift_out(0);  // NSS fell
  bench.put(kDr, 0x62);
  EXPECT_EQ(bench.slave().sampled(0, 8, 0), 0x61u);
  bench.slave().shift_out(0);  // the trailing edge of its last clock
  EXPECT_EQ(bench.get(kSr) & TXE, TXE);
  EXPECT_EQ(bench.slave().sampled(0, 8, 0), 0x62u);
}

TEST(SpiSlave, DmaFillsDrAByteAhead) {
  SlaveBench bench;
  bench.select(true);
  for (std::uint8_t i = 0; i < 3; ++i)
    bench.ram(0x20000000)[i] = static_cast<std::uint8_t>(0xB0 + i);
  const std::uint32_t stream = 0x40026400 + 0x10 + 0x18 * 3;  // DMA2 stream 3
  bench.put(stream + 4, 3);
  bench.put(stream + 8, kDr);
  bench.put(stream + 0xC, 0x20000000);
  bench.put(stream, (3u << 25) | (1u << 10) | (1u << 6) | 1);
  bench.put(kCr2, TXDMAEN);
  bench.run(1000);
  EXPECT_EQ(bench.get(stream + 4), 2u);  // one waits in DR
  bench.slave().shift_out(0);
  bench.run(1000);
  EXPECT_EQ(bench.get(stream + 4), 1u);  // before the first byte is through
  EXPECT_EQ(bench.slave().sampled(0, 8, 0), 0xB0u);
  EXPECT_EQ(bench.clock(0), 0xB1u);
}

}  // namespace
}  // namespace whirl::stm32
