// The MS5611 data sheet's calculation as it is printed, of integers (shifts round down) and of real
// numbers, written from the sheet and not from the part.
#pragma once
#include <array>
#include <cstdint>

namespace whirl::io {

struct SheetResult {
  double temperature_cdegC, pressure_Pa;
};

// C[1..6] are the coefficients.
inline SheetResult sheet_of_integers(const std::array<std::uint16_t, 8>& C, std::int64_t D1,
                                     std::int64_t D2) {
  const std::int64_t dT = D2 - std::int64_t{C[5]} * 256;
  std::int64_t TEMP = 2000 + (dT * C[6] >> 23);
  std::int64_t OFF = std::int64_t{C[2]} * 65536 + (C[4] * dT >> 7);
  std::int64_t SENS = std::int64_t{C[1]} * 32768 + (C[3] * dT >> 8);
  std::int64_t T2 = 0, OFF2 = 0, SENS2 = 0;
  if (TEMP < 2000) {
    T2 = dT * dT >> 31;
    OFF2 = 5 * (TEMP - 2000) * (TEMP - 2000) / 2;
    SENS2 = 5 * (TEMP - 2000) * (TEMP - 2000) / 4;
  }
  if (TEMP < -1500) {
    OFF2 += 7 * (TEMP + 1500) * (TEMP + 1500);
    SENS2 += 11 * (TEMP + 1500) * (TEMP + 1500) / 2;
  }
  const std::int64_t P = ((D1 * (SENS - SENS2) >> 21) - (OFF - OFF2)) >> 15;
  return {static_cast<double>(TEMP - T2), static_cast<double>(P)};
}

inline SheetResult sheet_of_reals(const std::array<std::uint16_t, 8>& C, double D1, double D2) {
  const double dT = D2 - C[5] * 256.0;
  const double TEMP = 2000.0 + dT * C[6] / 8388608.0;
  double T2 = 0.0, OFF2 = 0.0, SENS2 = 0.0;
  if (TEMP < 2000.0) {
    T2 = dT * dT / 2147483648.0;
    OFF2 = 2.5 * (TEMP - 2000.0) * (TEMP - 2000.0);
    SENS2 = 1.25 * (TEMP - 2000.0) * (TEMP - 2000.0);
  }
  if (TEMP < -1500.0) {
    OFF2 += 7.0 * (TEMP + 1500.0) * (TEMP + 1500.0);
    SENS2 += 5.5 * (TEMP + 1500.0) * (TEMP + 1500.0);
  }
  const double OFF = C[2] * 65536.0 + C[4] * dT / 128.0 - OFF2;
  const double SENS = C[1] * 32768.0 + C[3] * dT / 256.0 - SENS2;
  return {TEMP - T2, (D1 * SENS / 2097152.0 - OFF) / 32768.0};
}

}  // namespace whirl::io
