// The MS5611 on its two buses, as drivers poll it, and with its faults.
// Oracles: MS5611-01BA03 data sheet, "I2C interface" and "SPI mode"; PX4's and Betaflight's sequences.
#include <gtest/gtest.h>

#include "base/near.hpp"
#include "io_bridges/devices/tests/ms5611_bench.hpp"

namespace whirl::io {
namespace {

using Bytes = Ms5611Bench::Bytes;

const Tolerance kResolution_cdegC = stated(0.01, "a count of D2");
const Tolerance kResolution_Pa = stated(0.1, "a count of D1 and of D2");

// PX4: probe 0x76, then 0x77; RESET, 3 ms, PROM; one temperature, then three pressures at OSR 1024, 10 ms each.
TEST(Ms5611I2c, ADriversPolledSequenceGivesWhatIsThere) {
  Ms5611Bench bench;
  EXPECT_FALSE(bench.command(0x1E, 0x76));
  ASSERT_TRUE(bench.command(0x1E, 0x77));
  bench.run_us(3000);
  ms5611::Prom prom{};
  for (std::size_t i = 0; i < 8; ++i) {
    prom[i] = static_cast<std::uint16_t>(
        Ms5611Bench::word(bench.read(static_cast<std::uint8_t>(0xA0 + 2 * i), 2)));
  }
  EXPECT_EQ(ms5611::crc4(prom), prom[7] & 0x0F);
  for (int round = 0; round < 3; ++round) {
    bench.truth.pressure_Pa -= 500.0;
    bench.command(0x54);
    bench.run_us(10000);
    const std::uint32_t D2 = bench.adc();
    for (int i = 0; i < 3; ++i) {
      bench.command(0x44);
      bench.run_us(10000);
      const SheetResult got = sheet_of_reals(prom, bench.adc(), D2);
      EXPECT_TRUE(near(got.temperature_cdegC, 3150.0, kResolution_cdegC));
      EXPECT_TRUE(near(got.pressure_Pa, bench.truth.pressure_Pa, kResolution_Pa));
    }
  }
  EXPECT_TRUE(bench.findings.empty());
}

TEST(Ms5611I2c, ARepeatedStartReadsAsWell) {
  Ms5611Bench bench;
  bench.i2c.start(0);
  EXPECT_TRUE(bench.i2c.address(0x77, false, 0));
  EXPECT_TRUE(bench.i2c.write(0xA2, 0));
  bench.i2c.start(0);
  EXPECT_TRUE(bench.i2c.address(0x77, true, 0));
  EXPECT_EQ(bench.i2c.read(true, 0), 0x9C);
  EXPECT_EQ(bench.i2c.read(true, 0), 0xBF);
  EXPECT_EQ(bench.i2c.read(false, 0), 0x00);  // past the word
  bench.i2c.stop(0);
}

TEST(Ms5611I2c, ASecondByteIsIgnoredAndAFinding) {
  Ms5611Bench bench;
  bench.i2c.start(0);
  EXPECT_TRUE(bench.i2c.address(0x77, false, 0));
  EXPECT_TRUE(bench.i2c.write(0x48, 0));
  EXPECT_TRUE(bench.i2c.write(0x1E, 0));
  bench.i2c.stop(0);
  bench.run_us(9040);
  EXPECT_NE(bench.adc(), 0u);  // it was not reset
  EXPECT_EQ(bench.findings.size(), 1u);
}

TEST(Ms5611I2c, TheOtherAddressIsCsbHigh) {
  Ms5611::Params params = Ms5611Bench::silent();
  params.i2c_address = 0x76;
  Ms5611Bench bench(params);
  EXPECT_TRUE(bench.command(0x1E, 0x76));
  EXPECT_FALSE(bench.command(0x1E, 0x77));
}

// Betaflight and AutoQuad: RESET, PROM, then D2 and D1 in turn at OSR 4096.
TEST(Ms5611Spi, ADriversPolledSequenceGivesWhatIsThere) {
  Ms5611Bench bench;
  bench.transfer({0x1E});
  bench.run_us(2800);
  ms5611::Prom prom{};
  for (std::size_t i = 0; i < 8; ++i) {
    const Bytes got = bench.transfer({static_cast<std::uint8_t>(0xA0 + 2 * i), 0, 0});
    prom[i] = static_cast<std::uint16_t>(got[1] << 8 | got[2]);
  }
  EXPECT_EQ(prom, bench.params.prom);
  const auto convert = [&bench](std::uint8_t command) {
    bench.transfer({command});
    bench.run_us(9040);
    const Bytes got = bench.transfer({0x00, 0, 0, 0}, 20'000'000, 0);
    return Ms5611Bench::word({got[1], got[2], got[3]});
  };
  const std::uint32_t D2 = convert(0x58), D1 = convert(0x48);
  const SheetResult got = sheet_of_reals(prom, D1, D2);
  EXPECT_TRUE(near(got.temperature_cdegC, 3150.0, kResolution_cdegC));
  EXPECT_TRUE(near(got.pressure_Pa, 95000.0, kResolution_Pa));
  EXPECT_TRUE(bench.findings.empty());
}

TEST(Ms5611Spi, SdoIsLowWhileItConverts) {
  Ms5611Bench bench;
  bench.chip_select.drive(bench.driver, Drive::low, 0);
  bench.spi.transfer(0x48, 1'000'000, 0, 0);
  EXPECT_EQ(bench.spi.transfer(0, 1'000'000, 0, bench.now()), 0x00);
  bench.run_us(9040);
  EXPECT_EQ(bench.spi.transfer(0, 1'000'000, 0, bench.now()), 0xFF);
}

TEST(Ms5611Spi, WrongModeAndTooFastAClockAreFindings) {
  Ms5611Bench bench;
  EXPECT_EQ(bench.transfer({0xA2, 0, 0}, 1'000'000, 1), (Bytes{0xFF, 0xFF, 0xFF}));
  EXPECT_EQ(bench.findings.size(), 1u);
  EXPECT_EQ(bench.transfer({0xA2, 0, 0}, 20'000'001, 0)[1], 0x9C);
  EXPECT_EQ(bench.findings.size(), 2u);
}

// ---- Faults

Fault fault(FaultKind kind, double value = 0.0, int axis = 0) {
  return {.number = 7, .kind = kind, .bus = 2, .address = 0x77, .axis = axis, .value = value};
}

TEST(Ms5611Fault, FrozenRepeatsTheLastCountsOfEach) {
  Ms5611Bench bench;
  const SheetResult before = bench.measure();
  bench.faults.add(fault(FaultKind::sensor_frozen));
  bench.truth = {80000.0, 290.0};
  const SheetResult after = bench.measure();
  EXPECT_EQ(after.pressure_Pa, before.pressure_Pa);
  EXPECT_EQ(after.temperature_cdegC, before.temperature_cdegC);
  EXPECT_TRUE(bench.faults.pending().empty());
}

TEST(Ms5611Fault, OffsetIsAddedToItsAxis) {
  Ms5611Bench bench;
  bench.faults.add(fault(FaultKind::sensor_offset, -250.0, 0));
  const SheetResult low = bench.measure();
  EXPECT_TRUE(near(low.pressure_Pa, 94750.0, kResolution_Pa));
  EXPECT_TRUE(near(low.temperature_cdegC, 3150.0, kResolution_cdegC));
  Ms5611Bench warm;
  warm.faults.add(fault(FaultKind::sensor_offset, 2.0, 1));
  EXPECT_TRUE(near(warm.measure().temperature_cdegC, 3350.0, kResolution_cdegC));
}

TEST(Ms5611Fault, DriftGrowsByItsValueEachMinute) {
  Ms5611Bench bench;
  bench.faults.add(fault(FaultKind::sensor_drift, 240.0, 0));
  bench.queue.run_until(30'000'000'000);
  EXPECT_TRUE(near(bench.measure().pressure_Pa, 95120.0, kResolution_Pa));
  bench.queue.run_until(90'000'000'000);
  EXPECT_TRUE(near(bench.measure().pressure_Pa, 95360.0, kResolution_Pa));
}

TEST(Ms5611Fault, SaturatedReadsAllOnesOfItsAxis) {
  for (int axis = 0; axis < 2; ++axis) {
    Ms5611Bench bench;
    bench.faults.add(fault(FaultKind::sensor_saturated, 0.0, axis));
    EXPECT_EQ(bench.convert(0x48) == 0xFFFFFF, axis == 0);
    EXPECT_EQ(bench.convert(0x58) == 0xFFFFFF, axis == 1);
  }
}

TEST(Ms5611Fault, WrongIdentityBreaksTheCrc) {
  Ms5611Bench bench;
  const Bytes right = bench.read(0xAE, 2);
  bench.faults.add(fault(FaultKind::sensor_wrong_identity, 0x8001));
  EXPECT_EQ(bench.read(0xAE, 2), (Bytes{static_cast<std::uint8_t>(right.at(0) ^ 0x80),
                                        static_cast<std::uint8_t>(right.at(1) ^ 0x01)}));
  EXPECT_EQ(bench.read(0xA2, 2), (Bytes{0x9C, 0xBF}));
}

TEST(Ms5611Fault, LateConvertsLonger) {
  Ms5611Bench bench;
  bench.faults.add(fault(FaultKind::sensor_late, 0.005));
  bench.command(0x48);
  bench.run_us(9040);
  EXPECT_EQ(bench.sensed, 0);
  bench.run_us(8220 + 5000 - 9040);
  EXPECT_EQ(bench.sensed, 1);
}

TEST(Ms5611Fault, OfAnotherPartOrTimeDoesNothing) {
  Ms5611Bench bench;
  Fault other = fault(FaultKind::sensor_saturated);
  other.address = 0x76;
  bench.faults.add(other);
  Fault early = fault(FaultKind::sensor_saturated);
  early.end_ns = 1;
  bench.faults.add(early);
  EXPECT_NE(bench.convert(0x48), 0xFFFFFFu);
  EXPECT_EQ(bench.faults.pending().size(), 2u);
}

TEST(Ms5611Fault, TheBusHasItsOwn) {
  Ms5611Bench bench;
  Fault nack = fault(FaultKind::i2c_nack);
  nack.end_ns = 1;
  bench.faults.add(nack);
  EXPECT_FALSE(bench.command(0x48));
  bench.run_us(1);
  EXPECT_TRUE(bench.command(0x1E));
  bench.run_us(2800);
  Fault flip = fault(FaultKind::spi_flip, 8 + 7);
  flip.bus = 1;
  flip.address = 4;
  bench.faults.add(flip);
  EXPECT_EQ(bench.transfer({0xA2, 0, 0})[1], 0x9C ^ 0x80);
}

}  // namespace
}  // namespace whirl::io
