#include "io_bridges/devices/esc_i2c.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "io_bridges/devices/i2c_bus.hpp"

namespace whirl::io {
namespace {

struct Bench {
  I2cBus bus{"I2C3"};
  EscI2c esc{0x29};
  std::vector<EscI2c::Write> writes;

  Bench() {
    bus.add(esc);
    esc.on_setpoint([this](const EscI2c::Write& w) { writes.push_back(w); });
  }
  bool write(const std::vector<std::uint8_t>& bytes, Nanoseconds start, Nanoseconds stop) {
    bus.start(start);
    bool ack = bus.address(0x29, false, start);
    for (const std::uint8_t byte : bytes) ack = bus.write(byte, start) && ack;
    bus.stop(stop);
    return ack;
  }
  std::vector<std::uint8_t> read(int length) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(length));
    bus.start(0);
    bus.address(0x29, true, 0);
    for (std::uint8_t& byte : bytes) byte = bus.read(&byte != &bytes.back(), 0);
    bus.stop(0);
    return bytes;
  }
};

// v = 0x5A5: hi B4, lo 05; CRC by hand over 52 B4 05 (polynomial 0x07).
std::vector<std::uint8_t> good_write() {
  const auto bytes = pack_setpoint(0x29, 0x5A5);
  return {bytes.begin(), bytes.end()};
}

TEST(EscI2c, AGoodWriteIsASetpointWithTheTimesOfStartAndStop) {
  Bench bench;
  EXPECT_TRUE(bench.write(good_write(), 1000, 91'000));
  ASSERT_EQ(bench.writes.size(), 1u);
  EXPECT_TRUE(bench.writes[0].valid);
  EXPECT_EQ(bench.writes[0].v, 0x5A5);
  EXPECT_EQ(bench.writes[0].start_ns, 1000);
  EXPECT_EQ(bench.writes[0].stop_ns, 91'000);
}

TEST(EscI2c, BadLengthCrcAndUpperBitsAreAcknowledgedButCountedAsRejected) {
  const std::vector<std::vector<std::uint8_t>> bad = {
      {}, {0xB4}, {0xB4, 0x05}, {0xB4, 0x05, 0x00}, {0xB4, 0x0D, 0x00}, {0, 0, 0, 0}};
  for (const auto& bytes : bad) {
    Bench bench;
    EXPECT_TRUE(bench.write(bytes, 0, 1));
    ASSERT_EQ(bench.writes.size(), 1u);
    EXPECT_FALSE(bench.writes[0].valid) << bytes.size();
    EXPECT_EQ(bench.esc.rejected(), 1u);
  }
}

TEST(EscI2c, ARejectedWriteShowsInTheNextStatusOnly) {
  Bench bench;
  bench.write({0xFF}, 0, 1);
  EXPECT_EQ(bench.read(6)[4] & 0x80, 0x80);
  EXPECT_EQ(bench.read(6)[4] & 0x80, 0);
}

TEST(EscI2c, BeyondTheSixStatusBytesTheBusReadsFF) {
  Bench bench;
  bench.esc.set_status({1.25, 3950.0, EscFlag::kArmed});
  const auto bytes = bench.read(8);
  EXPECT_EQ(bytes[0] | bytes[1] << 8, 1250);
  EXPECT_EQ(bytes[2] | bytes[3] << 8, 3950);
  EXPECT_EQ(bytes[4], 0x01);
  EXPECT_EQ(bytes[6], 0xFF);
  EXPECT_EQ(bytes[7], 0xFF);
}

TEST(EscI2c, AStatusThatChangesDuringAReadDoesNotTearIt) {
  Bench bench;
  bench.esc.set_status({0.0, 0x1234, 0});
  bench.bus.start(0);
  bench.bus.address(0x29, true, 0);
  std::vector<std::uint8_t> bytes;
  for (int i = 0; i < 6; ++i) {
    bytes.push_back(bench.bus.read(i < 5, 0));
    bench.esc.set_status({0.0, 0x5678, 0});
  }
  EXPECT_TRUE(unpack_status(0x29, bytes));
  EXPECT_EQ(bytes[3], 0x12);
}

TEST(EscI2c, ARepeatedStartEndsAWriteToo) {
  Bench bench;
  bench.bus.start(0);
  bench.bus.address(0x29, false, 10);
  for (const std::uint8_t byte : good_write()) bench.bus.write(byte, 20);
  bench.bus.start(30);
  bench.bus.address(0x29, true, 40);
  EXPECT_EQ(bench.writes.size(), 1u);
  EXPECT_TRUE(bench.writes.at(0).valid);
}

TEST(EscI2c, NobodyAnswersAtAnotherAddress) {
  Bench bench;
  bench.bus.start(0);
  EXPECT_FALSE(bench.bus.address(0x2A, false, 0));
}

}  // namespace
}  // namespace whirl::io
