// The EEPROM by its data sheet's sequences (control bytes A0 and A1 at address 0x50).
#include "io_bridges/devices/eeprom_24xx.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "io_bridges/devices/i2c_bus.hpp"

namespace whirl::io {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr Nanoseconds kByte_ns = 22'500;  // nine clocks of 400 kHz

MemoryFile blank(std::int64_t size_bytes) {
  auto file = MemoryFile::create("", size_bytes);
  EXPECT_TRUE(file);
  file.value().write(0, Bytes(static_cast<std::size_t>(size_bytes), 0xFF));
  return std::move(file.value());
}

struct Bench {
  EventQueue queue;
  FaultBook faults;
  I2cBus bus{"I2C2"};
  Wire wp{"WP", false};
  int wp_driver = wp.add_driver();
  std::vector<std::string> findings;
  Eeprom24xx part;

  explicit Bench(int page_bytes = 64, std::int64_t size_bytes = 16384, std::uint64_t seed = 1)
      : part(queue, {.page_bytes = page_bytes, .seed = seed, .bus = 2}, blank(size_bytes), &wp,
             &faults, [this](const Finding& f) { findings.push_back(f.what); }) {
    bus.add(part);
  }

  Nanoseconds tick() {
    queue.run_until(queue.now() + kByte_ns);
    return queue.now();
  }
  void run_ms(double ms) { queue.run_until(queue.now() + static_cast<Nanoseconds>(ms * 1e6)); }

  bool acks() {  // a poll
    bus.start(queue.now());
    const bool acked = bus.address(0x50, false, tick());
    bus.stop(queue.now());
    return acked;
  }
  // S A0 bytes, and P where wanted. True: all acknowledged.
  bool write(const Bytes& bytes, bool stop = true) {
    bus.start(queue.now());
    bool acked = bus.address(0x50, false, tick());
    for (const std::uint8_t byte : bytes) acked = bus.write(byte, tick()) && acked;
    if (stop) bus.stop(queue.now());
    return acked;
  }
  Bytes read_on(int length) {  // S A1 ...
    bus.start(queue.now());
    EXPECT_TRUE(bus.address(0x50, true, tick()));
    Bytes got;
    for (int i = 0; i < length; ++i) got.push_back(bus.read(i + 1 < length, tick()));
    bus.stop(queue.now());
    return got;
  }
  Bytes read(int address, int length) {
    write({static_cast<std::uint8_t>(address >> 8), static_cast<std::uint8_t>(address)}, false);
    return read_on(length);
  }
  bool store(const Bytes& bytes) {
    const bool acked = write(bytes);
    run_ms(5.1);
    return acked;
  }
  void add(FaultKind kind, double start_ms, double end_ms, double value = 0.0) {
    faults.add({.number = 1,
                .kind = kind,
                .start_ns = static_cast<Nanoseconds>(start_ms * 1e6),
                .end_ns = static_cast<Nanoseconds>(end_ms * 1e6),
                .bus = 2,
                .address = 0x50,
                .value = value});
  }
};

TEST(Eeprom24xx, WhatIsWrittenIsReadBack) {
  Bench bench;
  EXPECT_TRUE(bench.store({0x01, 0x20, 0x12, 0x34}));
  EXPECT_EQ(bench.read(0x0120, 2), (Bytes{0x12, 0x34}));
  EXPECT_EQ(bench.read_on(1), Bytes{0xFF});  // the current address: 0x122
  EXPECT_TRUE(bench.findings.empty());
}

TEST(Eeprom24xx, AnswersNothingForFiveMillisecondsAfterAWrite) {
  Bench bench;
  bench.write({0x00, 0x00, 0xAA});
  const Nanoseconds stop_ns = bench.queue.now();
  while (!bench.acks()) ASSERT_LT(bench.queue.now(), stop_ns + 10'000'000);
  EXPECT_GE(bench.queue.now() - stop_ns, 5'000'000);
  EXPECT_LE(bench.queue.now() - stop_ns, 5'000'000 + 2 * kByte_ns);
  EXPECT_EQ(bench.read(0, 1), Bytes{0xAA});
}

TEST(Eeprom24xx, AWriteAcrossAPagesEndWrapsToItsStart) {
  Bench small(32, 8192), large(64);
  for (Bench* bench : {&small, &large}) bench->store({0x00, 0x3E, 0xAA, 0xBB, 0xCC});
  EXPECT_EQ(small.read(0x3E, 2), (Bytes{0xAA, 0xBB}));
  EXPECT_EQ(small.read(0x20, 1), Bytes{0xCC});
  EXPECT_EQ(large.read(0x00, 1), Bytes{0xCC});
  EXPECT_EQ(large.read(0x20, 1), Bytes{0xFF});
}

TEST(Eeprom24xx, ThirtyTwoByteWritesWorkOnLargerPages) {
  Bench bench;
  for (int page = 0; page < 4; ++page) {
    Bytes bytes{0x00, static_cast<std::uint8_t>(32 * page)};
    bytes.insert(bytes.end(), 32, static_cast<std::uint8_t>(page + 1));
    bench.store(bytes);
  }
  const Bytes got = bench.read(0, 128);
  for (std::size_t i = 0; i < got.size(); ++i) EXPECT_EQ(got[i], i / 32 + 1) << i;
}

TEST(Eeprom24xx, MoreThanAPageIsAFindingAndKeepsTheLast) {
  Bench bench;
  Bytes bytes{0x00, 0x00};
  for (int i = 0; i < 65; ++i) bytes.push_back(static_cast<std::uint8_t>(i));
  bench.store(bytes);
  EXPECT_EQ(bench.read(0, 2), (Bytes{64, 1}));
  EXPECT_EQ(bench.findings.size(), 1u);
}

TEST(Eeprom24xx, TheEndOfTheArrayIsFollowedByItsStart) {
  Bench bench;
  bench.store({0x00, 0x00, 0x11});
  bench.store({0x3F, 0xFF, 0x22});
  EXPECT_EQ(bench.read(0x3FFF, 2), (Bytes{0x22, 0x11}));
  EXPECT_EQ(bench.read(0x7FFF, 1), Bytes{0x22});  // the upper two bits do not count
}

TEST(Eeprom24xx, AStartInPlaceOfTheStopWritesNothing) {
  Bench bench;
  bench.write({0x00, 0x10, 0x55}, false);
  EXPECT_EQ(bench.read(0x10, 1), Bytes{0xFF});
  EXPECT_EQ(bench.part.cycles(), 0u);
}

TEST(Eeprom24xx, WriteProtectAcknowledgesAndKeepsTheBytesWithoutACycle) {
  Bench bench;
  bench.wp.drive(bench.wp_driver, Drive::high, 0);
  EXPECT_TRUE(bench.write({0x00, 0x00, 0x55}));
  EXPECT_TRUE(bench.acks());
  EXPECT_EQ(bench.read(0, 1), Bytes{0xFF});
  bench.wp.drive(bench.wp_driver, Drive::low, bench.queue.now());
  bench.store({0x00, 0x00, 0x55});
  EXPECT_EQ(bench.read(0, 1), Bytes{0x55});
}

// Over many parts a cut page shows new, old and erased bytes; its neighbours never change.
TEST(Eeprom24xx, ACutCycleSpoilsItsPageAndNoOther) {
  int of_new = 0, of_old = 0, erased = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Bench bench(64, 16384, seed);
    for (int page = 0; page < 3; ++page) {
      Bytes bytes{0, static_cast<std::uint8_t>(64 * page)};
      bytes.insert(bytes.end(), 64, 0x11);
      bench.store(bytes);
    }
    bench.add(FaultKind::memory_cut, 0.0, 50.0, 0.5);
    Bytes bytes{0, 64};
    bytes.insert(bytes.end(), 64, 0x22);
    bench.write(bytes);
    bench.run_ms(10.0);
    EXPECT_FALSE(bench.acks());  // without supply
    bench.run_ms(50.0);
    EXPECT_TRUE(bench.acks());
    const Bytes got = bench.read(0, 192);
    EXPECT_EQ(std::count(got.begin(), got.begin() + 64, 0x11), 64);
    EXPECT_EQ(std::count(got.begin() + 128, got.end(), 0x11), 64);
    of_new += static_cast<int>(std::count(got.begin() + 64, got.begin() + 128, 0x22));
    of_old += static_cast<int>(std::count(got.begin() + 64, got.begin() + 128, 0x11));
    erased += static_cast<int>(std::count(got.begin() + 64, got.begin() + 128, 0xFF));
    EXPECT_TRUE(bench.faults.pending().empty());
  }
  EXPECT_EQ(of_new + of_old + erased, 8 * 64);
  EXPECT_GT(of_new, 200);
  EXPECT_GT(of_old, 80);
  EXPECT_GT(erased, 80);
}

TEST(Eeprom24xx, AWriteErrorTakesItsTimeAndKeepsTheOldBytes) {
  Bench bench;
  bench.add(FaultKind::memory_write_error, 0.0, 100.0);
  EXPECT_TRUE(bench.write({0, 0, 0x55}));
  EXPECT_FALSE(bench.acks());
  bench.run_ms(5.1);
  EXPECT_EQ(bench.read(0, 1), Bytes{0xFF});
}

TEST(Eeprom24xx, AStuckCycleEndsWithItsFault) {
  Bench bench;
  bench.add(FaultKind::memory_busy, 0.0, 30.0);
  bench.write({0, 0, 0x55});
  bench.run_ms(25.0);
  EXPECT_FALSE(bench.acks());
  bench.run_ms(6.0);
  EXPECT_EQ(bench.read(0, 1), Bytes{0x55});
}

TEST(Eeprom24xx, WithoutSupplyItIsNotThereAndForgetsItsPointerOnly) {
  Bench bench;
  bench.store({0x00, 0x00, 0x77});
  bench.store({0x01, 0x00, 0x55});
  bench.add(FaultKind::memory_removed, 20.0, 30.0);
  bench.queue.run_until(25'000'000);
  EXPECT_FALSE(bench.acks());
  bench.queue.run_until(31'000'000);
  EXPECT_EQ(bench.read_on(1), Bytes{0x77});
  EXPECT_EQ(bench.read(0x100, 1), Bytes{0x55});
}

}  // namespace
}  // namespace whirl::io
