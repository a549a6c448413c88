// I2C slave (RM0090 27.3.2): the MCU at 0x29, an external 400 kHz master on the same two wires.
#include "io_bridges/devices/i2c_master.hpp"
#include "io_bridges/qemu/stm32/tests/i2c_bench.hpp"

namespace whirl::stm32 {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct SlaveBench : I2cBench {
  SlaveBench() : master(events(), bus(), 400e3) {
    put(kOar1, 0x4000 | (0x29 << 1));
    set_bits(kCr1, ACK);
  }
  void send(std::uint8_t address, Bytes bytes, int read = 0) {
    done = false;
    master.transfer({address, std::move(bytes), read}, [this](const io::I2cReply& r) {
      reply = r;
      done = true;
    });
  }
  void finish() {
    for (int i = 0; i < 100'000 && !done; ++i) run(100);
    ASSERT_TRUE(done);
  }
  void clear_stopf() {
    wait(kSr1, STOPF, STOPF);
    set_bits(kCr1, 1);
    EXPECT_EQ(get(kSr1) & STOPF, 0u);
  }

  io::I2cMaster master;
  io::I2cReply reply;
  bool done = false;
};

TEST(I2cSlave, ReceivesASetPointAsThePolledHalDoes) {
  SlaveBench bench;
  bench.send(0x29, {0x12, 0x03, 0xAB});
  bench.wait(kSr1, ADDR, ADDR);
  EXPECT_EQ(bench.get(kSr2), 2u);  // EV1: BUSY, neither MSL nor TRA
  Bytes got;
  for (int i = 0; i < 3; ++i) got.push_back(bench.received());
  bench.clear_stopf();
  EXPECT_EQ(got, (Bytes{0x12, 0x03, 0xAB}));
  EXPECT_TRUE(bench.reply.acked);
  EXPECT_EQ(bench.get(kSr2), 0u);
  EXPECT_EQ(bench.get(kSr1), 0u);
}

TEST(I2cSlave, HoldsTheClockUntilAddrIsCleared) {
  SlaveBench bench;
  bench.send(0x29, {0x55});
  bench.wait(kSr1, ADDR, ADDR);
  EXPECT_FALSE(bench.bus().scl().level());
  bench.run(50'000);
  EXPECT_EQ(bench.get(kSr1), ADDR);  // nothing came meanwhile
  bench.get(kSr2);
  EXPECT_TRUE(bench.bus().scl().level());
  const Nanoseconds t = bench.now();
  EXPECT_EQ(bench.wait(kSr1, RXNE, RXNE) - t, 9 * kBit_ns);
  bench.finish();
  EXPECT_GE(bench.reply.stretched_ns, 50'000);
}

TEST(I2cSlave, HoldsTheClockWhenBothItsRegistersAreFull) {
  SlaveBench bench;
  bench.send(0x29, {1, 2, 3});
  bench.clear_addr();
  bench.wait(kSr1, BTF, BTF);
  EXPECT_FALSE(bench.bus().scl().level());
  bench.run(200'000);
  EXPECT_FALSE(bench.done);
  EXPECT_EQ(bench.received(), 1);
  EXPECT_EQ(bench.get(kSr1) & (RXNE | BTF), RXNE);
  EXPECT_EQ(bench.received(), 2);
  EXPECT_EQ(bench.received(), 3);
  bench.clear_stopf();
  EXPECT_TRUE(bench.reply.acked);
}

TEST(I2cSlave, SendsItsStatusAndHearsTheFinalNack) {
  SlaveBench bench;
  bench.send(0x29, {}, 3);
  bench.wait(kSr1, ADDR, ADDR);
  EXPECT_EQ(bench.get(kSr1), ADDR | TXE);
  EXPECT_EQ(bench.get(kSr2), 6u);           // BUSY, TRA
  EXPECT_FALSE(bench.bus().scl().level());  // nothing to send yet
  bench.run(40'000);
  for (std::uint32_t byte : {0xA1u, 0xA2u, 0xA3u}) {
    bench.wait(kSr1, TXE, TXE);
    bench.put(kDr, byte);
  }
  bench.wait(kSr1, AF, AF);
  bench.put(kSr1, ~AF & 0xFFFF);
  bench.finish();
  EXPECT_EQ(bench.reply.bytes, (Bytes{0xA1, 0xA2, 0xA3}));
  EXPECT_EQ(bench.get(kSr1), 0u);  // no STOPF after a NACK
  EXPECT_EQ(bench.get(kSr2), 0u);
}

// TXE asks one byte ahead: what is loaded but refused must not open the next answer.
TEST(I2cSlave, AByteTooManyIsForgotten) {
  SlaveBench bench;
  for (std::uint8_t first : {std::uint8_t{0x10}, std::uint8_t{0x80}}) {
    bench.send(0x29, {}, 1);
    bench.clear_addr();
    bench.put(kDr, first);
    bench.put(kDr, first + 1u);
    bench.wait(kSr1, AF, AF);
    bench.put(kSr1, 0);
    bench.finish();
    EXPECT_EQ(bench.reply.bytes, (Bytes{first}));
  }
}

TEST(I2cSlave, WriteThenRepeatedStartReadIsARegisterRead) {
  SlaveBench bench;
  bench.send(0x29, {0x07}, 2);
  bench.clear_addr();
  EXPECT_EQ(bench.received(), 7);
  bench.wait(kSr1, ADDR, ADDR);
  EXPECT_EQ(bench.get(kSr1) & STOPF, 0u);
  EXPECT_EQ(bench.get(kSr2) & 4, 4u);
  bench.put(kDr, 0x70);
  bench.put(kDr, 0x71);
  bench.wait(kSr1, AF, AF);
  bench.finish();
  EXPECT_EQ(bench.reply.bytes, (Bytes{0x70, 0x71}));
}

// 400 kHz: nine clocks are 22.5 us. A slave that reads late holds SCL, and the byte behind comes late.
TEST(I2cSlave, TheLogSaysWhenEachByteHadPassed) {
  SlaveBench bench;
  io::I2cTransaction logged;
  bench.bus().on_transaction([&logged](const io::I2cTransaction& t) { logged = t; });
  bench.send(0x29, {0x12, 0x03, 0xAB});
  bench.clear_addr();
  EXPECT_EQ(bench.received(), 0x12);
  EXPECT_EQ(bench.received(), 0x03);
  EXPECT_EQ(bench.received(), 0xAB);
  bench.finish();
  ASSERT_EQ(logged.bytes, (Bytes{0x12, 0x03, 0xAB}));
  ASSERT_EQ(logged.passed_ns.size(), 3u);
  EXPECT_GE(logged.passed_ns[0], logged.start_ns + 45'000);  // the address before it
  for (int i = 1; i < 3; ++i) {
    EXPECT_GE(logged.passed_ns[i] - logged.passed_ns[i - 1], 22'500) << i;
    EXPECT_LT(logged.passed_ns[i] - logged.passed_ns[i - 1], 24'000) << i;
  }
  EXPECT_LE(logged.passed_ns[2], logged.stop_ns);
}

TEST(I2cSlave, AnswersOnlyItsAddressesAndOnlyWithAck) {
  SlaveBench bench;
  bench.send(0x2A, {1});
  bench.finish();
  EXPECT_FALSE(bench.reply.acked);
  bench.clear_bits(kCr1, ACK);
  bench.send(0x29, {1});
  bench.finish();
  EXPECT_FALSE(bench.reply.acked);
  EXPECT_EQ(bench.get(kSr1), 0u);
  bench.set_bits(kCr1, ACK);
  bench.put(kOar2, (0x2A << 1) | 1);
  bench.send(0x2A, {1});
  bench.wait(kSr1, ADDR, ADDR);
  EXPECT_EQ(bench.get(kSr2) & 0x80, 0x80u);  // DUALF
  bench.finish();
  EXPECT_TRUE(bench.reply.acked);
}

TEST(I2cSlave, GeneralCallNeedsEngc) {
  SlaveBench bench;
  bench.send(0x00, {6});
  bench.finish();
  EXPECT_FALSE(bench.reply.acked);
  bench.set_bits(kCr1, 0x40);
  bench.send(0x00, {6});
  bench.wait(kSr1, ADDR, ADDR);
  EXPECT_EQ(bench.get(kSr2) & 0x10, 0x10u);  // GENCALL
  EXPECT_EQ(bench.received(), 6);
  bench.finish();
}

TEST(I2cSlave, WithoutStretchingALateReaderOverruns) {
  SlaveBench bench;
  bench.set_bits(kCr1, 0x80);  // NOSTRETCH
  bench.send(0x29, {1, 2, 3});
  bench.finish();
  EXPECT_TRUE(bench.reply.acked);
  EXPECT_EQ(bench.reply.stretched_ns, 0);
  EXPECT_EQ(bench.get(kSr1) & OVR, OVR);
  EXPECT_EQ(bench.get(kDr), 1u);
}

TEST(I2cSlave, InterruptsComeForAddrByteAndStop) {
  SlaveBench bench;
  bench.set_bits(kCr2, 0x0700);  // ITBUFEN ITEVTEN ITERREN
  bench.send(0x29, {9});
  const auto until_irq = [&] {
    for (int i = 0; i < 10'000 && !bench.irq(31); ++i) bench.run(100);
    ASSERT_TRUE(bench.irq(31));
  };
  until_irq();
  EXPECT_EQ(bench.get(kSr1), ADDR);
  bench.get(kSr2);
  EXPECT_FALSE(bench.irq(31));
  until_irq();
  EXPECT_EQ(bench.get(kSr1), RXNE);
  bench.get(kDr);
  until_irq();
  EXPECT_EQ(bench.get(kSr1), STOPF);
  bench.set_bits(kCr1, 1);
  EXPECT_FALSE(bench.irq(31));
}

TEST(I2cSlave, DmaTakesAWholeSetPoint) {
  SlaveBench bench;
  bench.set_bits(0x40023830, 1u << 21);
  constexpr std::uint32_t kStream0 = 0x40026010;
  bench.put(kStream0 + 8, kDr);
  bench.put(kStream0 + 0xC, 0x20000000);
  bench.put(kStream0 + 4, 3);
  bench.put(kStream0, (1u << 25) | (1u << 10) | 1);
  bench.set_bits(kCr2, 0x0800);
  bench.send(0x29, {1, 2, 3});
  bench.clear_addr();
  bench.clear_stopf();
  EXPECT_EQ(std::memcmp(bench.ram(0x20000000), "\1\2\3", 3), 0);
}

TEST(I2cSlave, AnOwnStartWaitsForTheOthersStop) {
  SlaveBench bench;
  bench.send(0x50, {0x10, 0x99});  // another target, not us
  bench.run(30'000);
  bench.set_bits(kCr1, START);
  bench.run(5'000);
  EXPECT_EQ(bench.get(kSr1), 0u);
  bench.finish();
  const Nanoseconds stop = bench.reply.stop_ns;
  const Nanoseconds start = bench.wait(kSr1, SB, SB);
  EXPECT_GE(start - stop, kBit_ns / 2);
  EXPECT_EQ(bench.file.bytes[0x10], 0x99);
}

// The clock goes away inside a byte and the master gives up: no STOP, and the bit that was being sent
// stays on the wire until the block is set up anew.
TEST(I2cSlave, ATransmitterWhoseClockIsGoneKeepsItsBitUntilItIsDisabled) {
  SlaveBench bench;
  bench.send(0x29, {}, 3);
  bench.clear_addr();
  bench.put(kDr, 0x00);
  bench.run(5'000);  // two bits of nine
  bench.bus().scl().force(io::Drive::low, bench.now());
  bench.run(26'000'000);
  ASSERT_TRUE(bench.done);
  EXPECT_TRUE(bench.reply.timed_out);
  bench.bus().scl().force(io::Drive::none, bench.now());
  EXPECT_FALSE(bench.bus().sda().level());
  EXPECT_EQ(bench.get(kSr1) & STOPF, 0u);
  EXPECT_EQ(bench.get(kSr2) & 2u, 2u);  // BUSY
  bench.put(kCr1, 0);
  EXPECT_TRUE(bench.bus().sda().level());
  bench.put(kCr1, 1);
  bench.put(kCr1, 1 | ACK);
  bench.send(0x29, {0x12});
  bench.clear_addr();
  EXPECT_EQ(bench.received(), 0x12);
  bench.clear_stopf();
  bench.finish();
  EXPECT_FALSE(bench.reply.timed_out);
}

TEST(I2cSlave, AByteInWhichTheClockIsHeldEndsWhenItRuns) {
  SlaveBench bench;
  bench.send(0x29, {0x77});
  bench.clear_addr();
  bench.run(5'000);
  bench.bus().scl().force(io::Drive::low, bench.now());
  bench.run(100'000);
  EXPECT_EQ(bench.get(kSr1) & RXNE, 0u);
  bench.bus().scl().force(io::Drive::none, bench.now());
  EXPECT_EQ(bench.received(), 0x77);
  bench.clear_stopf();
  bench.finish();
  EXPECT_TRUE(bench.reply.acked);
  EXPECT_GE(bench.reply.stretched_ns, 70'000);  // 100 us but for the bits that had to come anyhow
}

}  // namespace
}  // namespace whirl::stm32
