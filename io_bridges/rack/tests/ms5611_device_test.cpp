// The barometer as a board carries it: from the keys of a board file and a message to counts on a bus.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "base/near.hpp"
#include "io_bridges/devices/ms5611_calibration.hpp"
#include "io_bridges/devices/tests/ms5611_sheet.hpp"
#include "io_bridges/rack/tests/bench_rack.hpp"

namespace whirl::rack {
namespace {

using Bytes = BenchRack::Bytes;
using Prom = std::array<std::uint16_t, 8>;

BoardDevice quiet(const std::string& bus) {
  BoardDevice device{.name = "baro", .type = "ms5611", .bus = bus};
  for (const char* path : {"params.turn_on_bias", "params.drift", "params.noise"}) {
    device.set(path, 0.0);
  }
  return device;
}
BoardDevice on_i2c() {
  BoardDevice device = quiet("i2c1");
  device.address = 0x76;
  return device;
}
BoardDevice on_spi() {
  BoardDevice device = quiet("spi1");
  device.set("cs", "PC4");
  return device;
}

Bytes ask(BenchRack& rack, bool spi, std::uint8_t command, std::size_t length) {
  if (!spi) return rack.i2c_transfer(0x76, Bytes(1, command), static_cast<int>(length));
  Bytes sent(length + 1, 0);
  sent[0] = command;
  const Bytes got = rack.spi_transfer("PC4", sent);
  return Bytes(got.begin() + 1, got.end());
}
Prom read_prom(BenchRack& rack, bool spi) {
  Prom prom{};
  for (std::size_t i = 0; i < 8; ++i) {
    const Bytes got = ask(rack, spi, static_cast<std::uint8_t>(0xA0 + 2 * i), 2);
    prom[i] = static_cast<std::uint16_t>(got[0] << 8 | got[1]);
  }
  return prom;
}
double convert(BenchRack& rack, bool spi, std::uint8_t command) {
  ask(rack, spi, command, 0);
  rack.run_ms(10.0);
  const Bytes got = ask(rack, spi, 0x00, 3);
  return got[0] << 16 | got[1] << 8 | got[2];
}
io::SheetResult measure(BenchRack& rack, bool spi) {
  const double D2 = convert(rack, spi, 0x58), D1 = convert(rack, spi, 0x48);
  return io::sheet_of_reals(read_prom(rack, spi), D1, D2);
}
io::BodyMotion still_air(double pressure_Pa, double temperature_K) {
  io::BodyMotion motion;
  motion.static_pressure_Pa = pressure_Pa;
  motion.air_temperature_K = temperature_K;
  return motion;
}

TEST(Ms5611Device, ItsCountsAreTheAirsPressureAndTemperatureOnEitherBus) {
  for (const bool spi : {false, true}) {
    BenchRack rack;
    ASSERT_NE(rack.add(spi ? on_spi() : on_i2c()), nullptr) << rack.error;
    rack.send(still_air(88000.0, 261.0));
    const io::SheetResult got = measure(rack, spi);
    EXPECT_TRUE(near(got.pressure_Pa, 88000.0, stated(0.1, "a count of D1 and of D2")));
    EXPECT_TRUE(near(got.temperature_cdegC, -1215.0, stated(0.01, "a count of D2")));
    EXPECT_TRUE(rack.findings.empty());
    EXPECT_FALSE(rack.write_refused);
  }
}

TEST(Ms5611Device, LagsBehindAStepOfThePressure) {
  BenchRack rack;
  BoardDevice device = on_i2c();
  device.set("params.lag", 1.0);
  ASSERT_NE(rack.add(device), nullptr);
  rack.send(still_air(90000.0, 300.0));
  const double before_Pa = measure(rack, false).pressure_Pa;
  rack.send(still_air(91000.0, 300.0));
  rack.run_ms(1000.0);
  const double after_Pa = measure(rack, false).pressure_Pa;
  // 1 s and, for the two conversions, up to 40 ms.
  const double want_Pa = 1000.0 * (1.0 - std::exp(-1.02));
  EXPECT_TRUE(near(after_Pa - before_Pa, want_Pa, stated(20.0, "the time of the conversions")));
}

TEST(Ms5611Device, WindTakesItsShareOfTheDynamicPressure) {
  BenchRack rack;
  BoardDevice device = on_i2c();
  device.set("params.wind_share", -0.5);
  ASSERT_NE(rack.add(device), nullptr);
  io::BodyMotion motion = still_air(101325.0, 288.15);
  motion.v_AB_B_mps[1] = 20.0;
  rack.send(motion);
  const double want_Pa = 101325.0 - 0.5 * 0.5 * 1.225 * 400.0;  // the density of the standard
  EXPECT_TRUE(near(measure(rack, false).pressure_Pa, want_Pa, stated(0.2, "counts")));
}

TEST(Ms5611Device, RotorsTakeTheirShareOfTheDiscLoading) {
  for (const double share : {0.1, -0.3}) {
    BenchRack rack;
    BoardDevice device = on_i2c();
    device.set("params.rotor_share", share);
    device.set("params.disc_area_m2", 0.2);
    ASSERT_NE(rack.add(device), nullptr);
    io::BodyMotion motion = still_air(101325.0, 288.15);
    motion.rotor_thrust_N[0] = 5.0;
    motion.rotor_thrust_N[3] = 3.0;
    rack.send(motion);
    const double want_Pa = 101325.0 + share * 8.0 / 0.2;
    EXPECT_TRUE(near(measure(rack, false).pressure_Pa, want_Pa, stated(0.2, "counts"))) << share;
  }
}

TEST(Ms5611Device, EachPartIsAnotherAndAGivenCoefficientIsThat) {
  std::set<int> first, factory, serial;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    BenchRack rack(seed);
    BoardDevice device = on_i2c();
    device.set("params.c3", 23456.0);
    ASSERT_NE(rack.add(device), nullptr);
    const Prom prom = read_prom(rack, false);
    EXPECT_EQ(prom[3], 23456);
    EXPECT_EQ(io::ms5611::crc4(prom), prom[7] & 0x0F);
    first.insert(prom[1]);
    factory.insert(prom[0]);
    serial.insert(prom[7] >> 4);
  }
  for (const auto& all : {first, factory, serial}) EXPECT_EQ(all.size(), 5u);
}

TEST(Ms5611Device, AFaultFindsItByAddressOnI2cAndByNumberOnSpi) {
  for (const bool spi : {false, true}) {
    BenchRack rack;
    ASSERT_NE(rack.add(spi ? on_spi() : on_i2c()), nullptr);
    rack.book.add({.number = 1,
                   .kind = io::FaultKind::sensor_saturated,
                   .bus = 1,
                   .address = spi ? 0 : 0x76});
    EXPECT_EQ(convert(rack, spi, 0x48), 0xFFFFFF);
    EXPECT_TRUE(rack.book.pending().empty());
  }
}

TEST(Ms5611Device, ABusThatThePartLacksIsAnError) {
  BenchRack rack;
  BoardDevice device = on_spi();
  device.bus = "spi7";
  EXPECT_EQ(rack.add(device), nullptr);
  EXPECT_NE(rack.error.find("spi7"), std::string::npos);
}

}  // namespace
}  // namespace whirl::rack
