// The MS5611's PROM and the counts behind its calculation: what the ADC must read so that the data
// sheet's algorithm gives a pressure and a temperature back.
//
//   Units    Pa, K; counts as real numbers, not yet rounded to the ADC's 24 bits
//   Valid    10..1200 mbar, -40..85 degC (the sheet's range); beyond it the same formulas go on
//   Method   the sheet's TEMP, OFF and SENS of first and second order, solved for D2, then for D1. T2
//            depends on dT, OFF2 and SENS2 on TEMP before T2 is taken off, as in the sheet
//   Source   MS5611-01BA03 data sheet, "Pressure and temperature calculation", "Second order
//            temperature compensation"; CRC: AN520, section "CRC-4"
//   Error    the sheet's worked example exact; a round trip over the whole range within the last
//            digit of the sheet's integers (tests/ms5611_calibration_test.cpp)
//   Unknown  how far coefficients differ from part to part: no source states it, so the spread is a
//            parameter of ours, around the sheet's typical values
#pragma once
#include <array>
#include <cstdint>
#include <string>

namespace whirl::io::ms5611 {

using Prom = std::array<std::uint16_t, 8>;  // word 0 factory data, 1..6 C1..C6, 7 serial and CRC
using Coefficients = std::array<std::uint16_t, 6>;  // C1..C6

inline constexpr Coefficients kTypical = {40127, 36924, 23317, 23282, 33464, 28312};

// Of all words but the low byte of the last, where it stands in bits 3..0.
std::uint8_t crc4(const Prom& prom);
// With its CRC. The serial number has 12 bits.
Prom make_prom(const Coefficients& coefficients, std::uint16_t factory, std::uint16_t serial);
// Each coefficient evenly within +-spread of its typical value. Pre: 0 <= spread < 0.5.
Coefficients draw_coefficients(double spread, std::uint64_t seed, const std::string& name);

double counts_of_temperature(const Prom& prom, double temperature_K);                   // D2
double counts_of_pressure(const Prom& prom, double pressure_Pa, double temperature_K);  // D1

// The sheet's calculation itself, of real numbers.
struct Air {
  double pressure_Pa, temperature_K;
};
Air compensated(const Prom& prom, double pressure_counts, double temperature_counts);

}  // namespace whirl::io::ms5611
