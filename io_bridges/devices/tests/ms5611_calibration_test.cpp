// Oracles: the worked example of the MS5611-01BA03 data sheet and two cold cases, AN520's CRC example
// (both also in Betaflight's unit test), and the sheet's formulas (ms5611_sheet.hpp).
#include "io_bridges/devices/ms5611_calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "base/near.hpp"
#include "io_bridges/devices/tests/ms5611_sheet.hpp"

namespace whirl::io::ms5611 {
namespace {

const Prom kExample = {0, 40127, 36924, 23317, 23282, 33464, 28312, 0};
constexpr std::int64_t kD1 = 9085466;
struct Case {
  std::int64_t D2;
  double temperature_cdegC, pressure_Pa;
};
constexpr Case kCases[] = {
    {8569150, 2007.0, 100009.0}, {8069150, 205.0, 96512.0}, {7369150, -2710.0, 90613.0}};

double kelvin(double temperature_cdegC) {
  return 273.15 + temperature_cdegC / 100.0;
}

TEST(Ms5611Crc, TheExampleOfTheApplicationNote) {
  const Prom prom = {0x3132, 0x3334, 0x3536, 0x3738, 0x3940, 0x4142, 0x4344, 0x450B};
  EXPECT_EQ(crc4(prom), 0x0B);
}

TEST(Ms5611Crc, AnyFlippedBitOfWhatItCoversChangesIt) {
  const Prom prom = make_prom(kTypical, 0x1234, 0xABC);
  EXPECT_EQ(prom[7] >> 4, 0xABC);
  EXPECT_EQ(prom[7] & 0x0F, crc4(prom));
  for (unsigned bit = 0; bit < 120; ++bit) {  // the last eight are not covered
    Prom flipped = prom;
    flipped[bit / 16] = static_cast<std::uint16_t>(flipped[bit / 16] ^ 0x8000u >> bit % 16);
    EXPECT_NE(crc4(flipped), crc4(prom)) << bit;
  }
}

TEST(Ms5611Calibration, TheSheetsExampleAndTwoColdOnesAsPrinted) {
  for (const Case& c : kCases) {
    const SheetResult got = sheet_of_integers(kExample, kD1, c.D2);
    EXPECT_EQ(got.temperature_cdegC, c.temperature_cdegC);
    EXPECT_EQ(got.pressure_Pa, c.pressure_Pa);
  }
}

// The printed results have lost what is below their last digit; the same formulas of real numbers have not.
TEST(Ms5611Calibration, TheExamplesPressuresAndTemperaturesGiveTheirCounts) {
  for (const Case& c : kCases) {
    const SheetResult exact = sheet_of_reals(kExample, kD1, static_cast<double>(c.D2));
    EXPECT_TRUE(near(exact.temperature_cdegC, c.temperature_cdegC, stated(1.0, "shifts")));
    const double T_K = kelvin(exact.temperature_cdegC);
    EXPECT_TRUE(
        near(counts_of_temperature(kExample, T_K), static_cast<double>(c.D2), counts(0.01, 1.0)));
    EXPECT_TRUE(near(counts_of_pressure(kExample, exact.pressure_Pa, T_K), kD1, counts(0.01, 1.0)));
  }
}

void check_round_trip(const Prom& prom, double T_cdegC, double P_Pa) {
  const long D2 = std::lround(counts_of_temperature(prom, kelvin(T_cdegC)));
  const long D1 = std::lround(counts_of_pressure(prom, P_Pa, kelvin(T_cdegC)));
  ASSERT_TRUE(D1 >= 0 && D1 <= 0xFFFFFF && D2 >= 0 && D2 <= 0xFFFFFF) << D1 << " " << D2;
  const SheetResult exact = sheet_of_reals(prom, static_cast<double>(D1), static_cast<double>(D2));
  EXPECT_TRUE(near(exact.temperature_cdegC, T_cdegC, stated(0.003, "half a count of D2")));
  EXPECT_TRUE(near(exact.pressure_Pa, P_Pa, stated(0.05, "half a count of D1 and of D2")));
  const SheetResult whole = sheet_of_integers(prom, D1, D2);
  EXPECT_TRUE(near(whole.temperature_cdegC, T_cdegC, stated(1.01, "its last digit")));
  const Tolerance warm = stated(1.1, "its last digit");
  const Tolerance cold = stated(6.0, "its last digit, and that of TEMP through OFF2 and SENS2");
  EXPECT_TRUE(near(whole.pressure_Pa, P_Pa, T_cdegC >= 2000.0 ? warm : cold)) << T_cdegC;
}

TEST(Ms5611Calibration, RoundTripOverTheWholeRange) {
  for (double T_cdegC = -4000.0; T_cdegC <= 8500.0; T_cdegC += 250.0) {
    for (double P_Pa = 1000.0; P_Pa <= 120000.0; P_Pa += 7000.0) {
      check_round_trip(kExample, T_cdegC, P_Pa);
    }
  }
}

TEST(Ms5611Calibration, EachPartHasCoefficientsOfItsOwnAndStaysWithin24Bits) {
  std::set<Coefficients> all;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const Coefficients drawn = draw_coefficients(0.05, seed, "baro");
    all.insert(drawn);
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_TRUE(near(drawn[i], kTypical[i], stated(0.05 * kTypical[i] + 0.5, "the spread")));
    }
    for (const double T_cdegC : {-4000.0, 8500.0}) {
      for (const double P_Pa : {1000.0, 120000.0}) {
        check_round_trip(make_prom(drawn, 0, 0), T_cdegC, P_Pa);
      }
    }
  }
  EXPECT_EQ(all.size(), 50u);
  EXPECT_EQ(draw_coefficients(0.05, 7, "baro"), draw_coefficients(0.05, 7, "baro"));
  EXPECT_NE(draw_coefficients(0.05, 7, "baro"), draw_coefficients(0.05, 7, "baro2"));
  EXPECT_EQ(draw_coefficients(0.0, 7, "baro"), kTypical);
}

}  // namespace
}  // namespace whirl::io::ms5611
