#include "io_bridges/copper/clock_fit.hpp"

#include <gtest/gtest.h>

#include "base/near.hpp"

namespace whirl::copper {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

// An analyser whose clock runs 80 ppm fast, and began 5 s before the host's zero; 0.4 ms to say "now".
MarkerPulse pulse_at(double host_s, double jitter_ns = 0.0) {
  const auto host_ns = static_cast<std::int64_t>(host_s * 1e9);
  return {host_ns - 200'000, host_ns + 200'000,
          static_cast<std::int64_t>((host_s + 5.0) * 1e9 * 1.00008 + jitter_ns)};
}

TEST(ClockFit, TwoPulsesGiveOffsetAndRate) {
  const auto fit = fit_clocks({pulse_at(1.0), pulse_at(61.0)});
  ASSERT_TRUE(fit);
  const std::int64_t at_31_s = pulse_at(31.0).analyser_ns;
  EXPECT_TRUE(
      near(static_cast<double>(fit->host_ns(at_31_s)), 31e9, stated(2.0, "whole nanoseconds")));
  EXPECT_TRUE(near(fit->rate, 1.0 / 1.00008, stated(1e-9, "whole nanoseconds in a minute")));
  EXPECT_TRUE(fit->rate_known);
  EXPECT_TRUE(
      near(fit->residue_ns, 200e3, stated(2.0, "half of the interval in which it was asked")));
}

TEST(ClockFit, APulseOffTheLineIsInTheResidue) {
  const auto fit = fit_clocks({pulse_at(1.0), pulse_at(31.0, 70e3), pulse_at(61.0)});
  ASSERT_TRUE(fit);
  EXPECT_TRUE(near(fit->residue_ns, 270e3, stated(20.0, "70 us less 80 ppm of it")));
}

TEST(ClockFit, OnePulseKnowsNoRateAndSaysSo) {
  const auto fit = fit_clocks({pulse_at(1.0)});
  ASSERT_TRUE(fit);
  EXPECT_FALSE(fit->rate_known);
  const std::int64_t later = pulse_at(1.0).analyser_ns + 10 * kSecond_ns;
  EXPECT_TRUE(near(fit->residue_at_ns(later), 200e3 + 1e6, stated(1.0, "100 ppm of 10 s")));
}

TEST(ClockFit, PulsesThatGoBackOrAreNotThereFitNothing) {
  EXPECT_FALSE(fit_clocks({}));
  EXPECT_FALSE(fit_clocks({pulse_at(2.0), pulse_at(1.0)}));
}

}  // namespace
}  // namespace whirl::copper
