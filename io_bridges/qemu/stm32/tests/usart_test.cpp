// USART2 of an F405 at 115200 baud (RM0090 chapter 30), PCLK1 42 MHz, TX PA2, RX PA3.
#include "base/near.hpp"
#include "io_bridges/qemu/stm32/tests/chip_bench.hpp"

namespace whirl::stm32 {
namespace {

constexpr std::uint32_t kUsart = 0x40004400, kSr = kUsart, kDr = kUsart + 4, kBrr = kUsart + 8,
                        kCr1 = kUsart + 0xC, kCr2 = kUsart + 0x10, kCr3 = kUsart + 0x14;
constexpr std::uint32_t PE = 1, FE = 2, NF = 4, ORE = 8, IDLE = 16, RXNE = 32, TC = 64, TXE = 128,
                        LBD = 256;
constexpr Nanoseconds kByte_ns = 86'905;  // 10 bits x 365 / 42 MHz
const io::UartFormat k8N1{115200, 8, 'N', 1};

struct Far : io::UartPeer {
  void receive(const io::UartByte& byte, const io::UartFormat& f, Nanoseconds now) override {
    bytes.push_back(byte);
    at.push_back(now);
    format = f;
  }
  void say(std::uint8_t value, const io::UartFormat& f = k8N1) {
    io::UartByte byte;
    byte.value = value;
    send(byte, f);
  }
  void say_break() {
    io::UartByte byte;
    byte.is_break = true;
    send(byte, k8N1);
  }
  std::vector<io::UartByte> bytes;
  std::vector<Nanoseconds> at;
  io::UartFormat format;
};

struct UsartBench : ChipBench {
  explicit UsartBench(std::uint32_t cr1 = 0x200C) {
    clock_168();
    set_bits(0x40023840, 1u << 17);
    set_bits(0x40023830, 1u << 21);
    mux('A', 2, 7);
    mux('A', 3, 7);
    chip().join_uart(2, far);
    put(kBrr, 365);
    put(kCr1, cr1);
    run(1'000'000);  // TE's idle frame
  }
  Far far;
};

TEST(Usart, TxeAndTcAreSeparateMoments) {
  UsartBench bench;
  bench.get(kSr);
  bench.put(kDr, 'a');
  EXPECT_EQ(bench.get(kSr), TXE);  // TC went with SR read, DR written
  const Nanoseconds t = bench.now();
  bench.put(kDr, 'b');
  EXPECT_EQ(bench.get(kSr), 0u);
  EXPECT_TRUE(near(static_cast<double>(bench.wait(kSr, TXE, TXE) - t), kByte_ns,
                   stated(100.0, "the bench polls")));
  EXPECT_EQ(bench.get(kSr) & TC, 0u);
  EXPECT_TRUE(near(static_cast<double>(bench.wait(kSr, TC, TC) - t), 2.0 * kByte_ns,
                   stated(100.0, "the bench polls")));
  EXPECT_EQ(bench.far.at[1] - bench.far.at[0], kByte_ns);
}

TEST(Usart, TcStaysWhenOnlyDmaWritesDr) {
  UsartBench bench;
  bench.put(kDr, 'a');  // SR was not read before
  EXPECT_EQ(bench.get(kSr) & TC, TC);
  bench.put(kSr, ~TC & 0xFFFF);
  EXPECT_EQ(bench.get(kSr) & TC, 0u);
  bench.wait(kSr, TC, TC);
}

TEST(Usart, TheFirstByteAfterTeWaitsForAnIdleFrame) {
  UsartBench bench(0);
  bench.put(kCr1, 0x2008);
  const Nanoseconds t = bench.now();
  bench.put(kDr, 'x');
  bench.run(1'000'000);
  EXPECT_EQ(bench.far.at[0] - t, 2 * kByte_ns);
}

TEST(Usart, AnUnreadByteIsKeptAndOreTellsOfTheLostOne) {
  UsartBench bench(0x202C);  // RXNEIE
  bench.far.say(1);
  EXPECT_TRUE(bench.irq(38));
  bench.far.say(2);
  EXPECT_EQ(bench.get(kSr) & (RXNE | ORE), RXNE | ORE);
  EXPECT_EQ(bench.get(kDr), 1u);
  EXPECT_EQ(bench.get(kSr) & (RXNE | ORE), 0u);
  EXPECT_FALSE(bench.irq(38));
}

TEST(Usart, IdleComesOnceAfterTheLineRestsAndClearsBySrThenDr) {
  UsartBench bench(0x201C);  // IDLEIE
  for (int i = 0; i < 3; ++i) {
    bench.far.say(static_cast<std::uint8_t>(i));
    bench.get(kDr);
    bench.run(kByte_ns);
    EXPECT_FALSE(bench.irq(38)) << i;  // the next byte follows at once
  }
  bench.run(3 * kByte_ns);
  EXPECT_TRUE(bench.irq(38));
  EXPECT_EQ(bench.get(kSr) & IDLE, IDLE);
  bench.get(kDr);
  EXPECT_EQ(bench.get(kSr) & IDLE, 0u);
  bench.run(100 * kByte_ns);
  EXPECT_EQ(bench.get(kSr) & IDLE, 0u);
}

TEST(Usart, ParityIsAddedAndChecked) {
  UsartBench bench(0x340C);  // M, PCE: 8 data bits and even parity
  bench.far.say(0x55, {115200, 8, 'E', 1});
  EXPECT_EQ(bench.get(kSr) & PE, 0u);
  bench.get(kDr);
  bench.far.say(0x55, {115200, 8, 'O', 1});
  EXPECT_EQ(bench.get(kSr) & PE, PE);
  bench.get(kDr);
  EXPECT_EQ(bench.get(kSr) & PE, 0u);
  bench.put(kDr, 0x31);
  bench.run(1'000'000);
  EXPECT_EQ(bench.far.format.parity, 'E');
  EXPECT_EQ(bench.far.format.data_bits, 8);
}

TEST(Usart, AWrongBaudRateGarbles) {
  UsartBench bench;
  bench.far.say(0x55, {115200 * 1.02, 8, 'N', 1});
  EXPECT_EQ(bench.get(kSr) & (FE | NF), 0u);
  EXPECT_EQ(bench.get(kDr), 0x55u);
  int spoiled = 0;
  for (const double factor : {0.5, 0.94, 1.06, 2.0}) {
    bench.far.say(0x55, {115200 * factor, 8, 'N', 1});
    const bool flagged = (bench.get(kSr) & (FE | NF)) != 0;
    if (bench.get(kDr) != 0x55u || flagged) ++spoiled;
  }
  EXPECT_EQ(spoiled, 4);
}

TEST(Usart, ABreakIsAZeroWithFramingErrorAndLbdInLinMode) {
  UsartBench bench;
  bench.far.say_break();
  EXPECT_EQ(bench.get(kSr) & (RXNE | FE | LBD), RXNE | FE);
  EXPECT_EQ(bench.get(kDr), 0u);
  bench.put(kCr2, 0x4000);
  bench.far.say_break();
  EXPECT_EQ(bench.get(kSr) & LBD, LBD);
  bench.set_bits(kCr1, 1);  // SBK
  bench.run(1'000'000);
  EXPECT_EQ(bench.get(kCr1) & 1, 0u);
  ASSERT_EQ(bench.far.bytes.size(), 1u);
  EXPECT_TRUE(bench.far.bytes[0].is_break);
}

// USARTDIV 12.3 bits with OVER8: 42 MHz / (22 x 8 + 6) = 230769 baud.
TEST(Usart, Over8HalvesTheSamplesPerBit) {
  UsartBench bench(0);
  bench.put(kCr1, 0x8000);
  bench.put(kBrr, (22u << 4) | 6);
  bench.put(kCr1, 0xA008);
  bench.put(kDr, 1);
  bench.run(1'000'000);
  EXPECT_TRUE(near(bench.far.format.baud, 230769.2, stated(0.1, "half of the last digit")));
}

TEST(Usart, StopBitsLengthenTheFrame) {
  UsartBench bench;
  bench.put(kCr2, 2u << 12);
  bench.put(kDr, 1);
  bench.put(kDr, 2);
  bench.run(1'000'000);
  EXPECT_TRUE(near(static_cast<double>(bench.far.at[1] - bench.far.at[0]), 11 * 365 / 42e6 * 1e9,
                   stated(1.0, "whole nanoseconds")));
}

TEST(Usart, HalfDuplexHearsTheFarEndOnTx) {
  UsartBench bench;
  bench.put(0x40020000, bench.get(0x40020000) & ~(3u << 6));  // PA3 is no longer RX
  bench.far.say(7);
  EXPECT_EQ(bench.get(kSr) & RXNE, 0u);
  bench.put(kCr3, 8);  // HDSEL
  bench.far.say(8);
  EXPECT_EQ(bench.get(kDr), 8u);
}

TEST(Usart, CtsHoldsBackTheNextCharacter) {
  UsartBench bench;
  bench.mux('A', 0, 7);
  io::Wire& cts = *bench.chip().pin("PA0");
  const int far_end = cts.add_driver();
  cts.drive(far_end, io::Drive::high, bench.now());
  bench.put(kCr3, 1u << 9);
  bench.put(kDr, 1);
  bench.run(1'000'000);
  EXPECT_TRUE(bench.far.bytes.empty());
  cts.drive(far_end, io::Drive::low, bench.now());
  bench.run(1'000'000);
  EXPECT_EQ(bench.far.bytes.size(), 1u);
}

// Circular DMA reception that is read out at IDLE: the common way of GPS and RC drivers.
TEST(Usart, CircularDmaReceptionWrapsAndIdleMarksThePause) {
  UsartBench bench;
  constexpr std::uint32_t kStream5 = 0x40026010 + 5 * 0x18;
  bench.put(kStream5 + 8, kDr);
  bench.put(kStream5 + 0xC, 0x20000000);
  bench.put(kStream5 + 4, 8);
  bench.put(kStream5, (4u << 25) | (1u << 10) | (1u << 8) | 1);
  bench.put(kCr3, 0x40);
  bench.set_bits(kCr1, 16);
  for (std::uint8_t i = 0; i < 11; ++i) {
    bench.far.say(i);
    bench.run(kByte_ns);
  }
  bench.run(3 * kByte_ns);
  EXPECT_TRUE(bench.irq(38));
  EXPECT_EQ(bench.get(kStream5 + 4), 5u);  // 8 - 11 mod 8
  EXPECT_EQ(std::memcmp(bench.ram(0x20000000), "\x08\x09\x0A\x03\x04\x05\x06\x07", 8), 0);
  EXPECT_EQ(bench.get(kSr) & ORE, 0u);
}

TEST(Usart, MuteModeWakesOnAnIdleLineOrOnItsAddress) {
  UsartBench bench;
  bench.set_bits(kCr1, 2);  // RWU, WAKE by idle line
  bench.far.say(1);
  EXPECT_EQ(bench.get(kSr) & RXNE, 0u);
  bench.run(5 * kByte_ns);
  EXPECT_EQ(bench.get(kCr1) & 2, 0u);
  bench.far.say(2);
  EXPECT_EQ(bench.get(kDr), 2u);
  bench.put(kCr2, 5);
  bench.set_bits(kCr1, 0x802);  // RWU, WAKE by address mark
  bench.far.say(0x84);
  EXPECT_EQ(bench.get(kSr) & RXNE, 0u);
  bench.far.say(0x85);
  EXPECT_EQ(bench.get(kSr) & RXNE, RXNE);
}

TEST(Usart, SendingWithoutAPinIsAFinding) {
  ChipBench bench;
  Far far;
  bench.chip().join_uart(6, far);
  bench.set_bits(0x40023844, 1u << 5);
  bench.put(0x40011408, 139);
  bench.put(0x4001140C, 0x2008);
  bench.put(0x40011404, 'x');
  bench.run(1'000'000);
  EXPECT_TRUE(far.bytes.empty());
  ASSERT_EQ(bench.findings.size(), 1u);
  EXPECT_EQ(bench.findings[0], "USART6: sending with no pin muxed to TX");
}

}  // namespace
}  // namespace whirl::stm32
