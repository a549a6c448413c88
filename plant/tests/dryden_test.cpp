#include "plant/air/dryden.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "base/near.hpp"

namespace whirl::plant {
namespace {

constexpr double kAirspeed_mps = 10.0, kHeight_m = 30.48, kStep_s = 0.01;  // 100 ft

using Spectrum = std::function<double(double w_radps)>;

constexpr int kSegment = 8192;

const std::vector<double>& hann() {
  static const std::vector<double> window = [] {
    std::vector<double> w(kSegment);
    for (int k = 0; k < kSegment; ++k) w[k] = 0.5 - 0.5 * std::cos(2.0 * M_PI * k / kSegment);
    return w;
  }();
  return window;
}

// One-sided density per rad/s at one frequency: segments under a Hann window, by Goertzel's
// recurrence, averaged.
double density(const std::vector<double>& x, double w_radps) {
  const std::vector<double>& window = hann();
  const double turn = 2.0 * std::cos(w_radps * kStep_s);
  double sum = 0.0;
  int count = 0;
  for (std::size_t start = 0; start + kSegment <= x.size(); start += kSegment / 2, ++count) {
    double last = 0.0, before = 0.0;
    for (int k = 0; k < kSegment; ++k) {
      const double now = x[start + k] * window[k] + turn * last - before;
      before = last;
      last = now;
    }
    const double square = last * last + before * before - turn * last * before;
    sum += square * kStep_s / (0.375 * kSegment * M_PI);
  }
  return sum / count;
}

// Measured over wanted, averaged over neighbouring frequencies.
double ratio(const std::vector<double>& x, double w_radps, const Spectrum& want) {
  double sum = 0.0;
  for (int bin = -4; bin <= 4; bin += 2) {
    const double w = w_radps + bin * 2.0 * M_PI / (kSegment * kStep_s);
    sum += density(x, w) / want(w) / 5.0;
  }
  return sum;
}

struct Record {
  std::vector<double> u, v, w, p, q, r;
};

const Record& record() {
  static const Record kept = [] {
    Dryden air({.wind_at_6m_mps = 8.0, .wingspan_m = 0.5}, 7);
    Record rec;
    for (int k = 0; k < 1'000'000; ++k) {
      const Gust g = air.step(kAirspeed_mps, kHeight_m, kStep_s);
      rec.u.push_back(g.velocity_mps.x());
      rec.v.push_back(g.velocity_mps.y());
      rec.w.push_back(g.velocity_mps.z());
      rec.p.push_back(g.rate_radps.x());
      rec.q.push_back(g.rate_radps.y());
      rec.r.push_back(g.rate_radps.z());
    }
    return rec;
  }();
  return kept;
}

// Scales by hand from [MIL8785C, 3.7.3] at 100 ft: 0.177 + 0.0823 = 0.2593.
constexpr double kLuv_m = 505.2 * 0.3048, kLw_m = 30.48, kSigmaW = 0.8, kSigmaUv = 1.3725;

TEST(Dryden, ScalesAreTheStandardsAtAHundredFeet) {
  const DrydenScales s = dryden_scales(kHeight_m, 8.0);
  EXPECT_TRUE(near(s.length_w_m, kLw_m, round_off(8, 30.0)));
  EXPECT_TRUE(near(s.length_uv_m, kLuv_m, stated(0.1, "worked by hand to 4 digits")));
  EXPECT_TRUE(near(s.sigma_w_mps, kSigmaW, round_off(8, 1.0)));
  EXPECT_TRUE(near(s.sigma_uv_mps, kSigmaUv, stated(1e-3, "worked by hand to 4 digits")));
}

// Spectra over wave number as printed, divided by V for the density over frequency.
double longitudinal(double w, double sigma, double length) {
  const double a = length * w / kAirspeed_mps;
  return sigma * sigma * 2.0 * length / (M_PI * kAirspeed_mps) / (1.0 + a * a);
}
double transverse(double w, double sigma, double length) {
  const double a = length * w / kAirspeed_mps;
  return sigma * sigma * length / (M_PI * kAirspeed_mps) * (1.0 + 3.0 * a * a) /
         std::pow(1.0 + a * a, 2);
}

TEST(Dryden, VelocitySpectraAreTheStandards) {
  for (double w : {0.6, 2.0, 6.0, 20.0, 60.0}) {
    const double u =
        ratio(record().u, w, [](double f) { return longitudinal(f, kSigmaUv, kLuv_m); });
    const double v = ratio(record().v, w, [](double f) { return transverse(f, kSigmaUv, kLuv_m); });
    const double z = ratio(record().w, w, [](double f) { return transverse(f, kSigmaW, kLw_m); });
    for (double each : {u, v, z}) EXPECT_TRUE(near(each, 1.0, stated(0.1, "statistics"))) << w;
  }
}

// q is the slope of the downdraft along the path, r the negative slope of the side gust.
TEST(Dryden, RatesHaveTheStandardsSigns) {
  double pitch = 0.0, yaw = 0.0;
  const Record& rec = record();
  for (std::size_t k = 1; k < rec.w.size(); ++k) {
    pitch += rec.q[k] * (rec.w[k] - rec.w[k - 1]);
    yaw += rec.r[k] * (rec.v[k] - rec.v[k - 1]);
  }
  EXPECT_GT(pitch, 0.0);
  EXPECT_LT(yaw, 0.0);
}

TEST(Dryden, RateSpectraAreTheStandards) {
  const double b = 0.5, V = kAirspeed_mps;
  auto roll = [&](double w) {
    const double a = 4.0 * b * w / (M_PI * V);
    return kSigmaW * kSigmaW / (V * kLw_m) * 0.8 * std::cbrt(M_PI * kLw_m / (4.0 * b)) /
           (1.0 + a * a);
  };
  auto pitch = [&](double w) {
    const double a = 4.0 * b * w / (M_PI * V);
    return w * w / (V * V) / (1.0 + a * a) * transverse(w, kSigmaW, kLw_m);
  };
  auto yaw = [&](double w) {
    const double a = 3.0 * b * w / (M_PI * V);
    return w * w / (V * V) / (1.0 + a * a) * transverse(w, kSigmaUv, kLuv_m);
  };
  for (double w : {1.0, 3.0, 10.0, 30.0}) {
    EXPECT_TRUE(near(ratio(record().p, w, roll), 1.0, stated(0.1, "statistics"))) << w;
    EXPECT_TRUE(near(ratio(record().q, w, pitch), 1.0, stated(0.1, "statistics"))) << w;
    EXPECT_TRUE(near(ratio(record().r, w, yaw), 1.0, stated(0.1, "statistics"))) << w;
  }
}

}  // namespace
}  // namespace whirl::plant
