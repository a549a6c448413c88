#include "io_bridges/devices/wire_faults.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "base/near.hpp"
#include "io_bridges/devices/esc_i2c.hpp"

namespace whirl::io {
namespace {

struct I2cBench {
  EventQueue queue;
  FaultBook book;
  I2cBus bus{"I2C3"};
  EscI2c esc{0x29}, other{0x2A};
  I2cWireFaults faults{queue, book, bus, 3};
  std::vector<std::uint32_t> applied;
  int heard = 0;

  I2cBench() {
    bus.add(esc);
    bus.add(other);
    esc.on_setpoint([this](const EscI2c::Write& w) { heard += w.valid ? 1 : 0; });
    book.on_applied([this](std::uint32_t number, Nanoseconds) { applied.push_back(number); });
  }
  // True when every byte was acknowledged.
  bool write_setpoint(std::uint8_t address = 0x29) {
    const Nanoseconds now = queue.now();
    bus.start(now);
    bool ack = bus.address(address, false, now);
    for (const std::uint8_t byte : pack_setpoint(address, 700)) {
      ack = ack && bus.write(byte, now);
    }
    bus.stop(now);
    return ack;
  }
};

Fault on_esc(FaultKind kind, double value = 0.0) {
  return {.number = 7,
          .kind = kind,
          .start_ns = 100,
          .end_ns = 200,
          .bus = 3,
          .address = 0x29,
          .value = value};
}

TEST(I2cFault, NackActsInItsWindowAtItsAddressAndIsReportedOnce) {
  I2cBench bench;
  bench.book.add(on_esc(FaultKind::i2c_nack));
  bench.queue.run_until(99);
  EXPECT_TRUE(bench.write_setpoint());
  EXPECT_EQ(bench.book.pending(), std::vector<std::uint32_t>{7});
  bench.queue.run_until(100);
  EXPECT_FALSE(bench.write_setpoint());
  EXPECT_FALSE(bench.write_setpoint());
  EXPECT_TRUE(bench.write_setpoint(0x2A));
  bench.queue.run_until(200);
  EXPECT_TRUE(bench.write_setpoint());
  EXPECT_EQ(bench.applied, std::vector<std::uint32_t>{7});
  EXPECT_EQ(bench.heard, 2);
}

TEST(I2cFault, NackOfTheSecondByteLetsTheFirstPass) {
  I2cBench bench;
  bench.book.add(on_esc(FaultKind::i2c_nack, 2));
  bench.queue.run_until(150);
  bench.bus.start(150);
  EXPECT_TRUE(bench.bus.address(0x29, false, 150));
  EXPECT_TRUE(bench.bus.write(1, 150));
  EXPECT_FALSE(bench.bus.write(2, 150));
}

TEST(I2cFault, SilenceHidesTheWriteFromTheTarget) {
  I2cBench bench;
  bench.book.add(on_esc(FaultKind::i2c_silence));
  bench.queue.run_until(150);
  EXPECT_FALSE(bench.write_setpoint());
  EXPECT_EQ(bench.heard, 0);
  EXPECT_EQ(bench.esc.writes(), 0u);
}

TEST(I2cFault, AFlippedBitIsAcknowledgedAndRejectedByItsCrc) {
  I2cBench bench;
  bench.book.add(on_esc(FaultKind::i2c_flip_bit, 8 * 1 + 2));
  bench.queue.run_until(150);
  EXPECT_TRUE(bench.write_setpoint());
  EXPECT_EQ(bench.heard, 0);
  EXPECT_EQ(bench.esc.rejected(), 1u);
}

TEST(I2cFault, ALateTargetHoldsTheClockForTheStatedTime) {
  I2cBench bench;
  bench.book.add(on_esc(FaultKind::i2c_late, 0.0005));
  bench.queue.run_until(150);
  bench.write_setpoint();
  EXPECT_EQ(bench.bus.released_ns(), 150 + 500'000);
}

TEST(I2cFault, StuckSdaLetsGoAfterNinePulsesOfScl) {
  I2cBench bench;
  Fault stuck = on_esc(FaultKind::i2c_stuck_sda, 9);
  stuck.end_ns = kNever;
  bench.book.add(stuck);
  bench.queue.run_until(150);
  EXPECT_FALSE(bench.bus.idle());
  EXPECT_EQ(bench.applied, std::vector<std::uint32_t>{7});
  const int gpio = bench.bus.scl().add_driver();
  bench.bus.scl().drive(gpio, Drive::pull_high, 150);
  for (int pulse = 1; pulse <= 9; ++pulse) {
    EXPECT_FALSE(bench.bus.sda().level()) << pulse;
    bench.bus.scl().drive(gpio, Drive::low, 150);
    bench.bus.scl().drive(gpio, Drive::pull_high, 150);
  }
  EXPECT_TRUE(bench.bus.idle());
}

TEST(I2cFault, StuckSdaWithoutPulseCountHoldsUntilItsEnd) {
  I2cBench bench;
  bench.book.add(on_esc(FaultKind::i2c_stuck_sda));
  bench.queue.run_until(199);
  EXPECT_FALSE(bench.bus.idle());
  bench.bus.start(199);
  bench.bus.address(0x29, true, 199);
  EXPECT_EQ(bench.bus.read(true, 199), 0x00);
  bench.bus.stop(199);
  bench.queue.run_until(200);
  EXPECT_TRUE(bench.bus.idle());
}

TEST(I2cFault, StuckSclKeepsTheBusBusy) {
  I2cBench bench;
  bench.book.add(on_esc(FaultKind::i2c_stuck_scl));
  bench.queue.run_until(150);
  EXPECT_FALSE(bench.bus.scl().level());
  bench.queue.run_until(250);
  EXPECT_TRUE(bench.bus.idle());
}

// Answers a count that goes up with every byte.
struct Counter : SpiTarget {
  std::uint8_t count = 0;
  void select(bool, Nanoseconds) override {}
  std::uint8_t transfer(std::uint8_t, std::uint32_t, int, Nanoseconds) override { return ++count; }
};

std::vector<std::uint8_t> burst(SpiTarget& target, Nanoseconds now) {
  target.select(true, now);
  std::vector<std::uint8_t> miso(3);
  for (std::uint8_t& byte : miso) byte = target.transfer(0, 1'000'000, 0, now);
  target.select(false, now);
  return miso;
}

TEST(SpiFault, FrozenRepeatsTheLastGoodBurst) {
  FaultBook book;
  Counter counter;
  SpiWireFaults wire(book, counter, 1, 0);
  book.add({.kind = FaultKind::spi_frozen, .start_ns = 10, .end_ns = 20, .bus = 1});
  const auto before = burst(wire, 5);
  EXPECT_EQ(burst(wire, 10), before);
  EXPECT_EQ(burst(wire, 19), before);
  EXPECT_NE(burst(wire, 20), before);
}

TEST(SpiFault, FrozenGoesBackBehindWhatAnotherFaultSpoiled) {
  FaultBook book;
  Counter counter;
  SpiWireFaults wire(book, counter, 1, 0);
  book.add({.kind = FaultKind::spi_flip, .start_ns = 10, .end_ns = 20, .bus = 1, .value = 7});
  book.add({.kind = FaultKind::spi_frozen, .start_ns = 20, .end_ns = 30, .bus = 1});
  const auto good = burst(wire, 5);
  burst(wire, 10);
  EXPECT_EQ(burst(wire, 20), good);
}

TEST(SpiFault, SilentReadsOnesAndFlipTurnsOneBit) {
  FaultBook book;
  Counter counter;
  SpiWireFaults wire(book, counter, 1, 0);
  book.add({.kind = FaultKind::spi_silent, .start_ns = 10, .end_ns = 20, .bus = 1});
  book.add({.kind = FaultKind::spi_flip, .start_ns = 30, .end_ns = 40, .value = 8 * 2 + 7});
  EXPECT_EQ(burst(wire, 10), (std::vector<std::uint8_t>{0xFF, 0xFF, 0xFF}));
  EXPECT_EQ(counter.count, 0);
  EXPECT_EQ(burst(wire, 30), (std::vector<std::uint8_t>{1, 2, 3 | 0x80}));
}

struct Talker : UartPeer {
  void receive(const UartByte&, const UartFormat&, Nanoseconds) override {}
  void say(int n) {
    for (int i = 0; i < n; ++i) send({.value = 0x00}, {.baud = 57600});
  }
};

TEST(UartFault, LossFlipAndSilenceActOnTheWayToTheMcu) {
  EventQueue queue;
  FaultBook book;
  Talker far;
  UartWireFaults wire(queue, book, far, 2, 1);
  int arrived = 0, changed = 0;
  wire.join([&](const UartByte& byte, const UartFormat&) {
    ++arrived;
    changed += byte.value != 0 ? 1 : 0;
  });
  book.add({.number = 1, .kind = FaultKind::uart_loss, .end_ns = 10, .bus = 2, .value = 0.25});
  book.add({.number = 2, .kind = FaultKind::uart_flip, .end_ns = 10, .bus = 2, .value = 0.1});
  book.add({.number = 3, .kind = FaultKind::uart_silence, .start_ns = 10, .bus = 2});
  far.say(10'000);
  EXPECT_TRUE(near(arrived, 7500, stated(4 * 43, "binomial, 4 sigma")));  // binomial, 4 sigma
  EXPECT_TRUE(near(changed, 750, stated(4 * 26, "binomial, 4 sigma")));
  queue.run_until(10);
  arrived = 0;
  far.say(100);
  EXPECT_EQ(arrived, 0);
  EXPECT_TRUE(book.pending().empty());
}

struct Ear : EarlyUartPeer {
  void begin(const UartByte& byte, const UartFormat&, Nanoseconds, Nanoseconds) override {
    begun.push_back(byte.value);
  }
  void receive(const UartByte& byte, const UartFormat&, Nanoseconds) override {
    passed.push_back(byte.value);
  }
  std::vector<std::uint8_t> begun, passed;
};

// What was decided at its start bit holds for all of it.
TEST(UartFault, BetweenTwoBoardsItActsOnWhatTheMcuSendsAsWell) {
  EventQueue queue;
  FaultBook book;
  Ear far;
  UartWireFaults wire(queue, book, far, 2, 1, UartWireFaults::Spoils::both_ways);
  book.add({.number = 1, .kind = FaultKind::uart_silence, .start_ns = 10, .end_ns = 20, .bus = 2});
  book.add({.number = 2, .kind = FaultKind::uart_flip, .start_ns = 30, .bus = 2, .value = 1.0});
  for (const Nanoseconds begins : {5, 15, 25, 35}) {
    queue.run_until(begins);
    wire.begin({.value = 0x0F}, {.baud = 57600}, begins, begins + 10);
    queue.run_until(begins + 9);
    wire.receive({.value = 0x0F}, {.baud = 57600}, begins + 9);
  }
  ASSERT_EQ(far.passed.size(), 3u);
  EXPECT_EQ(far.begun, far.passed);
  EXPECT_EQ(far.passed[0], 0x0F);
  EXPECT_EQ(far.passed[1], 0x0F);
  EXPECT_EQ(__builtin_popcount(far.passed[2] ^ 0x0F), 1);
}

// Of one part: the first must not hide the second.
TEST(FaultBook, TwoAxesMayBeOffAtOnce) {
  FaultBook book;
  std::vector<std::uint32_t> applied;
  book.on_applied([&applied](std::uint32_t number, Nanoseconds) { applied.push_back(number); });
  book.add({.number = 1, .kind = FaultKind::sensor_offset, .bus = 1, .axis = 0, .value = 0.5});
  book.add({.number = 2, .kind = FaultKind::sensor_offset, .bus = 1, .axis = 4, .value = 0.25});
  const auto at = [&book](int axis) {
    return book.apply(FaultKind::sensor_offset, 1, kAnywhere, 10, axis);
  };
  ASSERT_NE(at(0), nullptr);
  ASSERT_NE(at(4), nullptr);
  EXPECT_EQ(at(0)->value, 0.5);
  EXPECT_EQ(at(4)->value, 0.25);
  EXPECT_EQ(at(1), nullptr);
  EXPECT_EQ(applied, (std::vector<std::uint32_t>{1, 2}));
}

TEST(FaultBook, EveryKindHasANameThatLeadsBack) {
  for (std::uint32_t k = 1; k <= static_cast<std::uint32_t>(FaultKind::capture_turned); ++k) {
    const auto kind = static_cast<FaultKind>(k);
    EXPECT_EQ(fault_kind(name(kind)), kind) << k;
  }
  EXPECT_FALSE(fault_kind("i2c_furlong"));
}

}  // namespace
}  // namespace whirl::io
