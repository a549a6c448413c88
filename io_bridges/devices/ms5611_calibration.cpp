#include "io_bridges/devices/ms5611_calibration.hpp"

#include <cmath>

#include "base/check.hpp"
#include "base/random.hpp"

namespace whirl::io::ms5611 {
namespace {

// dT of the true temperature: of first order at 20 degC and above, below it the root of
// TEMP = 2000 + dT C6 / 2^23 - dT^2 / 2^31 that is 0 at 20 degC, without cancellation.
double dT_of(const Prom& prom, double temperature_K) {
  const double above_cdegC = (temperature_K - 273.15) * 100.0 - 2000.0;
  const double slope = prom[6] / 8388608.0;
  if (above_cdegC >= 0.0) return above_cdegC / slope;
  const double root = std::sqrt(slope * slope - 4.0 * above_cdegC / 2147483648.0);
  return 2.0 * above_cdegC / (slope + root);
}

// Pressure by D1 at that temperature.
struct Line {
  double first_cdegC, OFF, SENS;
};
Line line_of(const Prom& prom, double dT) {
  const double first_cdegC = 2000.0 + dT * prom[6] / 8388608.0;
  double OFF = prom[2] * 65536.0 + prom[4] * dT / 128.0;
  double SENS = prom[1] * 32768.0 + prom[3] * dT / 256.0;
  if (first_cdegC < 2000.0) {
    const double square = (first_cdegC - 2000.0) * (first_cdegC - 2000.0);
    OFF -= 5.0 * square / 2.0;
    SENS -= 5.0 * square / 4.0;
  }
  if (first_cdegC < -1500.0) {
    const double square = (first_cdegC + 1500.0) * (first_cdegC + 1500.0);
    OFF -= 7.0 * square;
    SENS -= 11.0 * square / 2.0;
  }
  return {first_cdegC, OFF, SENS};
}

}  // namespace

std::uint8_t crc4(const Prom& prom) {
  unsigned remainder = 0;
  for (std::size_t i = 0; i < 16; ++i) {
    const unsigned word = i / 2 == 7 ? prom[7] & 0xFF00u : prom[i / 2];
    remainder ^= i % 2 == 0 ? word >> 8 : word & 0xFFu;
    for (int bit = 0; bit < 8; ++bit) {
      const bool out = (remainder & 0x8000u) != 0;
      remainder = (remainder << 1 ^ (out ? 0x3000u : 0u)) & 0xFFFFu;
    }
  }
  return static_cast<std::uint8_t>(remainder >> 12);
}

Prom make_prom(const Coefficients& coefficients, std::uint16_t factory, std::uint16_t serial) {
  Prom prom{};
  prom[0] = factory;
  for (std::size_t i = 0; i < coefficients.size(); ++i) prom[i + 1] = coefficients[i];
  prom[7] = static_cast<std::uint16_t>(serial << 4);
  prom[7] = static_cast<std::uint16_t>(prom[7] | crc4(prom));
  return prom;
}

Coefficients draw_coefficients(double spread, std::uint64_t seed, const std::string& name) {
  WHIRL_CHECK(spread >= 0.0 && spread < 0.5, spread);
  RandomStream random(seed, name + ".coefficients");
  Coefficients drawn{};
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const double share = 1.0 + spread * (2.0 * random.uniform() - 1.0);
    drawn[i] = static_cast<std::uint16_t>(std::lround(kTypical[i] * share));
  }
  return drawn;
}

double counts_of_temperature(const Prom& prom, double temperature_K) {
  return dT_of(prom, temperature_K) + prom[5] * 256.0;
}

double counts_of_pressure(const Prom& prom, double pressure_Pa, double temperature_K) {
  const Line line = line_of(prom, dT_of(prom, temperature_K));
  return (pressure_Pa * 32768.0 + line.OFF) * 2097152.0 / line.SENS;
}

Air compensated(const Prom& prom, double pressure_counts, double temperature_counts) {
  const double dT = temperature_counts - prom[5] * 256.0;
  const Line line = line_of(prom, dT);
  const double cold_cdegC = line.first_cdegC < 2000.0 ? dT * dT / 2147483648.0 : 0.0;
  return {(pressure_counts * line.SENS / 2097152.0 - line.OFF) / 32768.0,
          (line.first_cdegC - cold_cdegC) / 100.0 + 273.15};
}

}  // namespace whirl::io::ms5611
