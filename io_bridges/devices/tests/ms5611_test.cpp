// Oracles: MS5611-01BA03 data sheet (conversion times, RMS resolution, commands), MS5837-30BA data
// sheet p. 11 (reading too early).
#include "io_bridges/devices/ms5611.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "io_bridges/devices/tests/ms5611_bench.hpp"

namespace whirl::io {
namespace {

using Bytes = Ms5611Bench::Bytes;

TEST(Ms5611, TheSheetsExampleCountsComeOverTheBus) {
  Ms5611Bench bench;
  bench.truth = {100009.0, 273.15 + 20.07};
  const SheetResult got =
      sheet_of_integers(bench.params.prom, bench.convert(0x48), bench.convert(0x58));
  EXPECT_TRUE(near(got.temperature_cdegC, 2007.0, stated(1.0, "its last digit")));
  EXPECT_TRUE(near(got.pressure_Pa, 100009.0, stated(1.0, "its last digit")));
}

// Shortest and longest in us.
TEST(Ms5611, EachOversamplingTakesItsTime) {
  const double table[5][2] = {{480, 600}, {950, 1170}, {1880, 2280}, {3720, 4540}, {7400, 9040}};
  for (int osr = 0; osr < 5; ++osr) {
    for (int end = 0; end < 2; ++end) {
      for (const int quantity : {0x40, 0x50}) {
        Ms5611::Params params = Ms5611Bench::silent();
        params.conversion_share = end;
        for (const double early_us : {-0.001, 0.0}) {
          Ms5611Bench bench(params);
          bench.command(static_cast<std::uint8_t>(quantity + 2 * osr));
          bench.run_us(table[osr][end] + early_us);
          EXPECT_EQ(bench.adc() != 0, early_us >= 0.0) << osr << " " << end;
        }
      }
    }
  }
}

TEST(Ms5611, ConversionTimeOfTheHalfwayPartLiesHalfway) {
  Ms5611Bench bench;
  bench.command(0x48);
  bench.run_us(8219.999);
  EXPECT_EQ(bench.sensed, 0);
  bench.run_us(0.001);
  EXPECT_EQ(bench.sensed, 1);
}

TEST(Ms5611, ReadWithoutAConversionIsZeroAndAFinding) {
  Ms5611Bench bench;
  EXPECT_EQ(bench.adc(), 0u);
  ASSERT_EQ(bench.findings.size(), 1u);
  EXPECT_NE(bench.findings[0].find("no result waiting"), std::string::npos);
}

TEST(Ms5611, ASecondReadIsZero) {
  Ms5611Bench bench;
  EXPECT_NE(bench.convert(0x48), 0u);
  EXPECT_TRUE(bench.findings.empty());
  EXPECT_EQ(bench.adc(), 0u);
  EXPECT_EQ(bench.findings.size(), 1u);
}

TEST(Ms5611, AReadTooEarlyIsZeroAndSpoilsTheResult) {
  Ms5611Bench bench;
  const std::uint32_t good = bench.convert(0x48);
  bench.command(0x48);
  bench.run_us(4000);
  EXPECT_EQ(bench.adc(), 0u);
  EXPECT_EQ(bench.findings.size(), 1u);
  bench.run_us(5040);
  EXPECT_GT(std::abs(static_cast<double>(bench.adc()) - good), 1000.0);
  EXPECT_EQ(bench.convert(0x48), good);  // the next is sound again
}

TEST(Ms5611, ACommandDuringAConversionSpoilsIt) {
  Ms5611Bench bench;
  const std::uint32_t good = bench.convert(0x48);
  bench.command(0x48);
  bench.run_us(100);
  const std::uint32_t wrong = bench.convert(0x48);
  EXPECT_GT(std::abs(static_cast<double>(wrong) - good), 1000.0);
  ASSERT_EQ(bench.findings.size(), 1u);
  EXPECT_NE(bench.findings[0].find("during another one"), std::string::npos);
}

TEST(Ms5611, ConvertingDropsAResultThatNobodyRead) {
  Ms5611Bench bench;
  bench.command(0x58);
  bench.run_us(9040);
  EXPECT_EQ(bench.convert(0x48),
            std::lround(ms5611::counts_of_pressure(bench.params.prom, bench.truth.pressure_Pa,
                                                   bench.truth.temperature_K)));
}

TEST(Ms5611, ResetTakes2800MicrosecondsAndCommandsMeanwhileAreLost) {
  Ms5611Bench bench;
  bench.command(0x48);
  bench.run_us(1000);
  EXPECT_TRUE(bench.command(0x1E));
  bench.run_us(2799.9);
  EXPECT_EQ(bench.read(0xA2, 2), (Bytes{0, 0}));
  EXPECT_EQ(bench.findings.size(), 1u);
  bench.run_us(0.1);
  EXPECT_EQ(bench.read(0xA2, 2), (Bytes{0x9C, 0xBF}));  // 40127
  bench.run_us(9040);
  EXPECT_EQ(bench.sensed, 0);  // the conversion was dropped
  EXPECT_EQ(bench.findings.size(), 1u);
}

TEST(Ms5611, ResetDropsAResultThatNobodyRead) {
  Ms5611Bench bench;
  bench.command(0x48);
  bench.run_us(9040);
  bench.command(0x1E);
  bench.run_us(2800);
  EXPECT_EQ(bench.adc(), 0u);
}

TEST(Ms5611, PromHoldsTheCalibrationAndItsCrc) {
  Ms5611::Params params = Ms5611Bench::silent();
  params.prom = ms5611::make_prom({1, 2, 3, 4, 5, 0xFFFE}, 0x1234, 0xABC);
  Ms5611Bench bench(params);
  ms5611::Prom read{};
  for (std::size_t i = 0; i < 8; ++i) {
    read[i] = static_cast<std::uint16_t>(
        Ms5611Bench::word(bench.read(static_cast<std::uint8_t>(0xA0 + 2 * i), 2)));
  }
  EXPECT_EQ(read, params.prom);
  EXPECT_EQ(read[0], 0x1234);
  EXPECT_EQ(read[6], 0xFFFE);
  EXPECT_EQ(ms5611::crc4(read), read[7] & 0x0F);
}

TEST(Ms5611, UnknownCommandsAreFindings) {
  for (const int byte : {0x01, 0x1F, 0x3E, 0x41, 0x4A, 0x4E, 0x57, 0x5A, 0x60, 0x9E, 0xA1, 0xB0}) {
    Ms5611Bench bench;
    EXPECT_TRUE(bench.command(static_cast<std::uint8_t>(byte)));
    bench.run_us(20000);
    EXPECT_EQ(bench.findings.size(), 1u) << byte;
    EXPECT_EQ(bench.sensed, 0) << byte;
  }
}

TEST(Ms5611, APromReadWhileConvertingIsAnsweredAndAFinding) {
  Ms5611Bench bench;
  bench.command(0x48);
  EXPECT_EQ(bench.read(0xA2, 2), (Bytes{0x9C, 0xBF}));
  ASSERT_EQ(bench.findings.size(), 1u);
  EXPECT_NE(bench.findings[0].find("PROM"), std::string::npos);
}

TEST(Ms5611, NoiseIsTheSheetsByOversampling) {
  const double rms_Pa[] = {6.5, 4.2, 2.7, 1.8, 1.2};
  const double rms_K[] = {0.012, 0.008, 0.005, 0.003, 0.002};
  constexpr int kSamples = 2000;
  for (int osr = 0; osr < 5; ++osr) {
    Ms5611::Params params = Ms5611Bench::silent();
    params.noise_scale = 1.0;
    Ms5611Bench bench(params);
    double sum_T = 0.0, sum_P = 0.0;
    for (int i = 0; i < kSamples; ++i) {
      // Each by itself: the noise of D2 would reach the pressure through OFF and SENS.
      const double D2 = bench.convert(static_cast<std::uint8_t>(0x50 + 2 * osr));
      const double D1 = bench.convert(static_cast<std::uint8_t>(0x40 + 2 * osr));
      const double calm_D2 = ms5611::counts_of_temperature(params.prom, bench.truth.temperature_K);
      const double T_cdegC = sheet_of_reals(params.prom, D1, D2).temperature_cdegC;
      const double P_Pa = sheet_of_reals(params.prom, D1, calm_D2).pressure_Pa;
      sum_T += std::pow(T_cdegC / 100.0 + 273.15 - bench.truth.temperature_K, 2);
      sum_P += std::pow(P_Pa - bench.truth.pressure_Pa, 2);
    }
    // The deviation of an RMS of n samples is 1 / sqrt(2 n) of it: 1.6 %.
    const auto tolerance = [](double rms) { return stated(0.08 * rms, "five sigma"); };
    EXPECT_TRUE(near(std::sqrt(sum_T / kSamples), rms_K[osr], tolerance(rms_K[osr])));
    EXPECT_TRUE(near(std::sqrt(sum_P / kSamples), rms_Pa[osr], tolerance(rms_Pa[osr])));
  }
}

TEST(Ms5611, TheSameSeedGivesTheSameCounts) {
  Ms5611::Params params = Ms5611Bench::silent();
  params.noise_scale = 1.0;
  Ms5611Bench a(params), b(params);
  params.seed = 2;
  Ms5611Bench c(params);
  const std::uint32_t first = a.convert(0x40);
  EXPECT_EQ(first, b.convert(0x40));
  EXPECT_NE(first, c.convert(0x40));
}

TEST(Ms5611, ABrownOutDropsTheConversionAndIsNotAcknowledgedMeanwhile) {
  Ms5611Bench bench;
  EXPECT_TRUE(bench.command(0x1E));
  bench.run_us(3000);
  EXPECT_TRUE(bench.command(0x48));
  const Nanoseconds from = bench.now();
  bench.faults.add({.number = 1,
                    .kind = FaultKind::sensor_brown_out,
                    .start_ns = from + 1'000'000,
                    .end_ns = from + 3'000'000,
                    .bus = 2,
                    .address = 0x77});
  bench.run_us(2000);
  EXPECT_FALSE(bench.command(0x00));
  bench.run_us(20'000);
  EXPECT_EQ(bench.read(0x00, 3), (Ms5611Bench::Bytes{0, 0, 0}));  // nothing was converted
  EXPECT_EQ(bench.sensed, 0);
}

}  // namespace
}  // namespace whirl::io
