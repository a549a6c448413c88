#include "io_bridges/devices/dlpf.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "base/near.hpp"

namespace whirl::io {
namespace {

constexpr double kStep_s = 125e-6;

// Gain and phase delay of the filter by feeding it a sine and correlating (one settled period).
std::complex<double> response(double bandwidth_Hz, double delay_s, double f_Hz) {
  Dlpf filter(bandwidth_Hz, delay_s, kStep_s);
  const auto period = static_cast<int>(std::lround(1.0 / (f_Hz * kStep_s)));
  const int settle = 40 * static_cast<int>(std::lround(1.0 / (bandwidth_Hz * kStep_s)));
  const double w = 2.0 * std::numbers::pi / period;
  std::complex<double> sum = 0.0;
  for (int i = 0; i < settle + period; ++i) {
    const double y = filter.step(std::sin(w * i));
    if (i >= settle) sum += y * std::polar(1.0, -w * i);
  }
  return sum * 2.0 / (static_cast<double>(period) * std::complex<double>(0.0, -1.0));
}

struct Row {
  double bandwidth_Hz, delay_s;
};
// Gyro and accelerometer columns of the DLPF table (RM-MPU-6000A-00, register 26).
constexpr Row kTable[] = {{256, 0.98e-3}, {188, 1.9e-3}, {98, 2.8e-3},  {42, 4.8e-3}, {20, 8.3e-3},
                          {10, 13.4e-3},  {5, 18.6e-3},  {184, 2.0e-3}, {94, 3.0e-3}, {44, 4.9e-3},
                          {21, 8.5e-3},   {10, 13.8e-3}, {5, 19.0e-3}};

TEST(Dlpf, IsThreeDecibelsDownAtThePrintedBandwidth) {
  for (const Row& row : kTable) {
    const double gain = std::abs(response(row.bandwidth_Hz, row.delay_s, row.bandwidth_Hz));
    EXPECT_TRUE(near(20.0 * std::log10(gain), -3.01,
                     stated(0.02 + 2e-3 * row.bandwidth_Hz, "recursion at 8 kHz")))
        << row.bandwidth_Hz;
  }
}

TEST(Dlpf, DelaysAsPrintedWhereRealPolesAllowIt) {
  for (const Row& row : kTable) {
    if (row.bandwidth_Hz < 15.0) continue;  // the printed delay is shorter than one pole's
    const double f_Hz = row.bandwidth_Hz / 40.0;
    const double phase = std::arg(response(row.bandwidth_Hz, row.delay_s, f_Hz));
    const double delay_s = -phase / (2.0 * std::numbers::pi * f_Hz);
    EXPECT_TRUE(near(delay_s, row.delay_s, stated(0.6 * kStep_s, "pure delay in whole steps")))
        << row.bandwidth_Hz;
  }
}

TEST(Dlpf, PassesAConstantUnchanged) {
  Dlpf filter(42.0, 4.8e-3, kStep_s);
  for (int i = 0; i < 10'000; ++i) filter.step(3.25);
  EXPECT_TRUE(near(filter.output(), 3.25, round_off(100, 3.25)));
}

}  // namespace
}  // namespace whirl::io
