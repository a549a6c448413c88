// I2C master: the sequences of RM0090 27.3.3 and of the drivers that are in the field, register by
// register. Reads must be acknowledged as the wire wants it: all but the last byte.
#include "base/near.hpp"
#include "io_bridges/qemu/stm32/tests/i2c_bench.hpp"

namespace whirl::stm32 {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(I2cMaster, WriteHasTxeAndBtfAsSeparateMoments) {
  I2cBench bench;
  bench.start_and_address(0xA0);
  bench.wait(kSr1, ADDR, ADDR);
  EXPECT_EQ(bench.get(kSr1), ADDR | TXE);
  EXPECT_EQ(bench.get(kSr2), 7u);   // EV6: MSL BUSY TRA
  EXPECT_EQ(bench.get(kSr1), TXE);  // EV8_1: both registers empty, no BTF yet
  bench.put(kDr, 0x20);
  EXPECT_EQ(bench.get(kSr1), TXE);  // EV8: DR has moved to the shift register
  bench.put(kDr, 0x77);
  EXPECT_EQ(bench.get(kSr1), 0u);  // both full
  const Nanoseconds t = bench.now();
  EXPECT_EQ(bench.wait(kSr1, TXE, TXE) - t, 9 * kBit_ns);
  EXPECT_EQ(bench.get(kSr1) & BTF, 0u);
  EXPECT_EQ(bench.wait(kSr1, BTF, BTF) - t, 18 * kBit_ns);
  bench.set_bits(kCr1, STOP);
  bench.wait(kCr1, STOP, 0);
  EXPECT_EQ(bench.get(kSr1), 0u);
  EXPECT_EQ(bench.get(kSr2), 0u);
  EXPECT_EQ(bench.file.bytes[0x20], 0x77);
  EXPECT_EQ(bench.file.log, "WP");
}

TEST(I2cMaster, SbNeedsSr1ReadBeforeTheAddress) {
  I2cBench bench;
  bench.set_bits(kCr1, START);
  bench.run(kBit_ns / 2);
  EXPECT_EQ(bench.get(kSr2) & 1, 1u);  // master half a bit after START on a free bus
  bench.run(10 * kBit_ns);
  bench.put(kDr, 0xA0);  // SR1 was not read since SB came up
  bench.run(20 * kBit_ns);
  EXPECT_EQ(bench.file.log, "");
  EXPECT_EQ(bench.get(kSr1), SB);
  bench.put(kDr, 0xA0);
  bench.run(20 * kBit_ns);
  EXPECT_EQ(bench.file.log, "W");
}

TEST(I2cMaster, NobodyThereGivesAfAndStopFreesTheBus) {
  I2cBench bench;
  bench.set_bits(kCr2, 0x100);  // ITERREN
  bench.start_and_address(0x42);
  bench.wait(kSr1, AF, AF);
  EXPECT_TRUE(bench.irq(32));
  EXPECT_EQ(bench.get(kSr1) & (ADDR | TXE | BTF), 0u);
  EXPECT_EQ(bench.get(kSr2), 3u);  // still master
  bench.put(kSr1, ~AF & 0xFFFF);
  EXPECT_FALSE(bench.irq(32));
  bench.set_bits(kCr1, STOP);
  bench.wait(kCr1, STOP, 0);
  EXPECT_EQ(bench.get(kSr2), 0u);
}

TEST(I2cMaster, ARefusedByteGivesAfWithoutBtf) {
  I2cBench bench;
  bench.file.refuse_at = 1;
  bench.point_at(0x10);
  bench.put(kDr, 1);
  bench.wait(kSr1, TXE, TXE);
  bench.put(kDr, 2);
  bench.wait(kSr1, AF, AF);
  EXPECT_EQ(bench.get(kSr1) & BTF, 0u);
  bench.run(20 * kBit_ns);
  EXPECT_EQ(bench.file.byte_at.size(), 2u);  // what waited in DR does not go out
}

// Master_Receive of one byte as the HAL does it: ACK off, ADDR cleared, STOP, then RXNE.
TEST(I2cMaster, HalReadsOneByte) {
  I2cBench bench;
  bench.set_bits(kCr1, ACK);
  bench.point_at(0x31);
  bench.start_and_address(0xA1);
  bench.wait(kSr1, ADDR, ADDR);
  bench.clear_bits(kCr1, ACK);
  bench.get(kSr1);
  bench.get(kSr2);
  bench.set_bits(kCr1, STOP);
  EXPECT_EQ(bench.received(), 0x31);
  bench.wait(kCr1, STOP, 0);
  EXPECT_EQ(bench.file.log, "WRnP");
  EXPECT_EQ(bench.file.fetched_at.size(), 1u);
}

// Others set STOP while ADDR still stretches the clock: the byte comes first all the same.
TEST(I2cMaster, StopBeforeAddrIsClearedStillReadsTheByte) {
  I2cBench bench;
  bench.point_at(0x31);
  bench.clear_bits(kCr1, ACK);
  bench.start_and_address(0xA1);
  bench.wait(kSr1, ADDR, ADDR);
  bench.set_bits(kCr1, STOP);
  bench.run(20'000);
  bench.get(kSr1);
  bench.get(kSr2);
  EXPECT_EQ(bench.received(), 0x31);
  bench.wait(kCr1, STOP, 0);
  EXPECT_EQ(bench.file.log, "WRnP");
}

// Two bytes as the HAL does it: ACK off and POS on while ADDR stretches, BTF, STOP, two reads.
TEST(I2cMaster, HalReadsTwoBytesWithPos) {
  I2cBench bench;
  bench.set_bits(kCr1, ACK);
  bench.point_at(0x31);
  bench.start_and_address(0xA1);
  bench.wait(kSr1, ADDR, ADDR);
  bench.clear_bits(kCr1, ACK);
  bench.set_bits(kCr1, POS);
  bench.get(kSr1);
  bench.get(kSr2);
  bench.wait(kSr1, BTF, BTF);
  bench.set_bits(kCr1, STOP);
  const Bytes got{static_cast<std::uint8_t>(bench.get(kDr)),
                  static_cast<std::uint8_t>(bench.get(kDr))};
  EXPECT_EQ(got, (Bytes{0x31, 0x32}));
  bench.wait(kCr1, STOP, 0);
  EXPECT_EQ(bench.file.log, "WRanP");
}

// The manual's order: POS and ACK before START, ADDR cleared, then ACK off.
TEST(I2cMaster, ManualReadsTwoBytesWithPos) {
  I2cBench bench;
  bench.point_at(0x31);
  bench.set_bits(kCr1, ACK | POS);
  bench.start_and_address(0xA1);
  bench.clear_addr();
  bench.clear_bits(kCr1, ACK);
  bench.wait(kSr1, BTF, BTF);
  bench.set_bits(kCr1, STOP);
  EXPECT_EQ(bench.get(kDr), 0x31u);
  EXPECT_EQ(bench.get(kDr), 0x32u);
  bench.run(100'000);
  EXPECT_EQ(bench.file.log, "WRanP");
}

// Three and more as HAL and manual do: BTF with N-2 in DR, ACK off, read, BTF, STOP, two reads.
TEST(I2cMaster, HalReadsSixBytes) {
  I2cBench bench;
  bench.set_bits(kCr1, ACK);
  bench.point_at(0x40);
  bench.start_and_address(0xA1);
  bench.clear_addr();
  Bytes got;
  for (int i = 0; i < 3; ++i) got.push_back(bench.received());
  bench.wait(kSr1, BTF, BTF);
  const std::size_t before = bench.file.fetched_at.size();
  bench.run(30 * kBit_ns);
  EXPECT_EQ(bench.file.fetched_at.size(), before);  // SCL is held while DR is full
  bench.clear_bits(kCr1, ACK);
  got.push_back(static_cast<std::uint8_t>(bench.get(kDr)));
  bench.wait(kSr1, BTF, BTF);
  bench.set_bits(kCr1, STOP);
  got.push_back(static_cast<std::uint8_t>(bench.get(kDr)));
  got.push_back(static_cast<std::uint8_t>(bench.get(kDr)));
  EXPECT_EQ(got, (Bytes{0x40, 0x41, 0x42, 0x43, 0x44, 0x45}));
  bench.wait(kCr1, STOP, 0);
  EXPECT_EQ(bench.file.log, "WRaaaaanP");
}

// libopencm3's loop: byte by byte on RXNE, ACK off before the last one is waited for, STOP last.
TEST(I2cMaster, LibopencmReadsThreeBytes) {
  I2cBench bench;
  bench.point_at(0x05);
  bench.set_bits(kCr1, START);
  bench.set_bits(kCr1, ACK);
  bench.wait(kSr1, SB, SB);
  bench.put(kDr, 0xA1);
  bench.clear_addr();
  Bytes got;
  for (int i = 0; i < 3; ++i) {
    if (i == 2) bench.clear_bits(kCr1, ACK);
    got.push_back(bench.received());
  }
  bench.set_bits(kCr1, STOP);
  bench.wait(kCr1, STOP, 0);
  EXPECT_EQ(got, (Bytes{5, 6, 7}));
  EXPECT_EQ(bench.file.log, "WRaanP");
}

TEST(I2cMaster, IsDeviceReadyStopsRightAfterTheAddress) {
  I2cBench bench;
  bench.start_and_address(0xA0);
  bench.wait(kSr1, ADDR, ADDR);
  bench.set_bits(kCr1, STOP);
  bench.get(kSr1);
  bench.get(kSr2);
  bench.wait(kSr2, 2, 0);
  EXPECT_EQ(bench.file.log, "WP");
  EXPECT_EQ(bench.file.written, 0);
}

// ChibiOS: interrupts for START and address, DMA with LAST for the bytes, STOP at the DMA's end.
TEST(I2cMaster, DmaReadNacksTheLastByteByItself) {
  I2cBench bench;
  bench.set_bits(0x40023830, 1u << 21);
  constexpr std::uint32_t kStream0 = 0x40026010;  // I2C1_RX, channel 1
  bench.put(kStream0 + 8, kDr);
  bench.put(kStream0 + 0xC, 0x20000000);
  bench.put(kStream0 + 4, 4);
  bench.set_bits(kCr1, ACK);
  bench.point_at(0x60);
  bench.put(kCr2, 42 | 0x0A00 | 0x1000);  // DMAEN, ITEVTEN, LAST
  bench.set_bits(kCr1, START);
  while (!bench.irq(31)) bench.run(100);
  bench.get(kSr1);
  bench.put(kDr, 0xA1);
  bench.run(100);
  while (!bench.irq(31)) bench.run(100);
  bench.put(kStream0, (1u << 25) | (1u << 10) | (1u << 4) | 1);
  bench.clear_addr();
  while (!bench.irq(11)) bench.run(100);
  bench.set_bits(kCr1, STOP);
  bench.wait(kCr1, STOP, 0);
  EXPECT_EQ(std::memcmp(bench.ram(0x20000000), "\x60\x61\x62\x63", 4), 0);
  EXPECT_EQ(bench.file.log, "WRaaanP");
}

TEST(I2cMaster, DmaWriteEndsInBtf) {
  I2cBench bench;
  bench.set_bits(0x40023830, 1u << 21);
  constexpr std::uint32_t kStream6 = 0x40026010 + 6 * 0x18;  // I2C1_TX, channel 1
  std::memcpy(bench.ram(0x20000000), "\x10wire", 5);
  bench.put(kStream6 + 8, kDr);
  bench.put(kStream6 + 0xC, 0x20000000);
  bench.put(kStream6 + 4, 5);
  bench.put(kStream6, (1u << 25) | (1u << 10) | (1u << 6) | (1u << 4) | 1);
  bench.put(kCr2, 42 | 0x0800);
  bench.start_and_address(0xA0);
  bench.clear_addr();
  bench.wait(kSr1, BTF, BTF);
  EXPECT_TRUE(bench.irq(17));
  bench.get(kDr);  // ChibiOS clears BTF by reading DR
  EXPECT_EQ(bench.get(kSr1) & BTF, 0u);
  bench.set_bits(kCr1, STOP);
  bench.wait(kCr1, STOP, 0);
  EXPECT_EQ(std::memcmp(&bench.file.bytes[0x10], "wire", 4), 0);
  EXPECT_EQ(bench.file.byte_at[4] - bench.file.byte_at[0], 4 * 9 * kBit_ns);
}

TEST(I2cMaster, StuckSdaKeepsBusyAndNinePulsesByGpioFreeIt) {
  I2cBench bench;
  constexpr std::uint32_t kGpioB = 0x40020400;
  bench.bus().sda().force(io::Drive::low, bench.now());
  EXPECT_EQ(bench.get(kSr2), 2u);
  bench.set_bits(kCr1, START);
  bench.run(1'000'000);
  EXPECT_EQ(bench.get(kSr1), 0u);
  bench.put(kCr1, 0);
  int pulses = 0;
  bench.bus().scl().watch([&](bool level, Nanoseconds now) {
    if (level && ++pulses == 9) bench.bus().sda().force(io::Drive::none, now);
  });
  bench.put(kGpioB + 0x18, 3u << 8);
  bench.put(kGpioB, (bench.get(kGpioB) & ~(0xFu << 16)) | (5u << 16));  // outputs, open drain
  while ((bench.get(kGpioB + 0x10) & (1u << 9)) == 0 && pulses < 20) {
    bench.put(kGpioB + 0x18, 1u << 24);
    bench.run(5000);
    bench.put(kGpioB + 0x18, 1u << 8);
    bench.run(5000);
  }
  EXPECT_EQ(pulses, 9);
  bench.mux('B', 8, 4, true);
  bench.mux('B', 9, 4, true);
  bench.put(kCr1, 1);
  bench.start_and_address(0xA0);
  bench.clear_addr();
  EXPECT_EQ(bench.file.log, "W");
}

TEST(I2cMaster, SdaLowUnderASentOneLosesArbitration) {
  I2cBench bench;
  bench.set_bits(kCr1, START);
  bench.wait(kSr1, SB, SB);
  bench.bus().sda().force(io::Drive::low, bench.now());
  bench.put(kDr, 0xA0);
  bench.wait(kSr1, ARLO, ARLO);
  EXPECT_EQ(bench.get(kSr2) & 1, 0u);  // no longer master
  EXPECT_EQ(bench.file.log, "");
}

TEST(I2cMaster, AByteEndsNoEarlierThanTheHeldClockRises) {
  I2cBench bench;
  bench.point_at(1);
  bench.bus().scl().force(io::Drive::low, bench.now());
  bench.run(300'000);
  EXPECT_TRUE(bench.file.byte_at.empty());
  bench.bus().scl().force(io::Drive::none, bench.now());
  bench.wait(kSr1, BTF, BTF);
  EXPECT_EQ(bench.file.byte_at.size(), 1u);
}

// A slave that holds the clock after its address is still looking for its byte.
TEST(I2cMaster, AHeldClockDelaysTheByteAndWhatIsInIt) {
  I2cBench bench;
  bench.point_at(0x31);
  bench.clear_bits(kCr1, ACK);
  bench.start_and_address(0xA1);
  bench.wait(kSr1, ADDR, ADDR);
  bench.bus().scl().force(io::Drive::low, bench.now());
  bench.clear_addr();
  bench.set_bits(kCr1, STOP);
  bench.run(100'000);
  EXPECT_TRUE(bench.file.fetched_at.empty());
  bench.file.bytes[0x31] = 0x77;
  const Nanoseconds released = bench.now();
  bench.bus().scl().force(io::Drive::none, released);
  EXPECT_EQ(bench.received(), 0x77);
  ASSERT_EQ(bench.file.fetched_at.size(), 1u);
  EXPECT_EQ(bench.file.fetched_at[0], released);
}

// A clock that stops in the middle of a byte delays it, and asks for no other one.
TEST(I2cMaster, AClockHeldWithinAByteAsksForItOnce) {
  I2cBench bench;
  bench.point_at(0x31);
  bench.clear_bits(kCr1, ACK);
  bench.start_and_address(0xA1);
  bench.clear_addr();
  bench.set_bits(kCr1, STOP);
  bench.run(4 * kBit_ns);
  bench.bus().scl().force(io::Drive::low, bench.now());
  bench.run(100'000);
  bench.bus().scl().force(io::Drive::none, bench.now());
  EXPECT_EQ(bench.received(), 0x31);
  EXPECT_EQ(bench.file.fetched_at.size(), 1u);
}

TEST(I2cMaster, SwrstAndPeOffLetGoOfTheBus) {
  for (const std::uint32_t way : {0x8000u, 0u}) {
    I2cBench bench;
    bench.point_at(1);
    bench.put(kCr1, way);
    EXPECT_EQ(bench.get(kSr1), 0u);
    EXPECT_EQ(bench.get(kSr2), 0u);
    EXPECT_TRUE(bench.bus().idle());
    EXPECT_EQ(bench.get(kCcr), way != 0 ? 0u : 0x8023u);  // SWRST resets the registers, PE does not
  }
}

TEST(I2cMaster, BitTimeFollowsCcrModeAndDuty) {
  struct Row {
    std::uint32_t ccr;
    Nanoseconds bit_ns;
  };
  // 42 MHz: standard 2 x 210, fast 3 x 35, fast 16:9 25 x 4
  for (const Row& row : {Row{210, 10'000}, Row{0x8000 | 35, 2500}, Row{0xC000 | 4, 2381}}) {
    I2cBench bench;
    bench.put(kCr1, 0);
    bench.put(kCcr, row.ccr);
    bench.put(kCr1, 1);
    bench.point_at(1);
    bench.put(kDr, 2);
    bench.wait(kSr1, BTF, BTF);
    EXPECT_TRUE(near(static_cast<double>(bench.file.byte_at[1] - bench.file.byte_at[0]),
                     9.0 * static_cast<double>(row.bit_ns),
                     stated(5.0, "whole nanoseconds of each of nine bits")));
  }
}

TEST(I2cMaster, StartWithoutPinsIsAFinding) {
  ChipBench bench;
  bench.set_bits(0x40023840, 1u << 21);
  bench.put(kCr2, 16);
  bench.put(kCcr, 80);
  bench.put(kCr1, 1);
  bench.set_bits(kCr1, START);
  bench.run(1'000'000);
  EXPECT_EQ(bench.get(kSr1), 0u);
  ASSERT_EQ(bench.findings.size(), 1u);
  EXPECT_EQ(bench.findings[0], "I2C1: START with SCL or SDA not muxed to a pin");
}

}  // namespace
}  // namespace whirl::stm32
