#include "harness/metrics/response.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "harness/base/near.hpp"

namespace whirl::metrics {
namespace {

const double kNaN = std::nan("");
constexpr std::size_t kBefore = 300;

// f(t after the command, in s), after 300 ms at `rest`.
std::vector<double> answer(double rest, double seconds, const std::function<double(double)>& f) {
  std::vector<double> values(kBefore, rest);
  for (int i = 0; i < static_cast<int>(seconds * 1000.0); ++i) values.push_back(f(i * 0.001));
  return values;
}
Record record(const std::vector<double>& values) {
  return {values, 1'000'000, kBefore};
}

// A first-order lag rises from 10 to 90 % in tau ln 9 and reaches 90 % after tau ln 10.
TEST(Response, FirstOrderLagRisesInTauTimesLogNine) {
  const double tau = 0.05;
  const auto v = answer(2.0, 2.0, [&](double t) { return 3.2 - 1.2 * std::exp(-t / tau); });
  const auto tol = stated(2e-5, "linear interpolation of an exponential at 1 ms: h^2/8 tau");
  EXPECT_TRUE(near(rise_time_s(record(v)), tau * std::log(9.0), tol));
  EXPECT_TRUE(near(response_time_s(record(v)), tau * std::log(10.0), tol));
  EXPECT_TRUE(std::isnan(fall_time_s(record(v))));
}

TEST(Response, AFallIsAMirroredRise) {
  const double tau = 0.05;
  const auto v = answer(3.2, 2.0, [&](double t) { return 2.0 + 1.2 * std::exp(-t / tau); });
  EXPECT_TRUE(near(fall_time_s(record(v)), tau * std::log(9.0), stated(2e-5, "interpolation")));
  EXPECT_TRUE(std::isnan(rise_time_s(record(v))));
}

// A second-order step overshoots by exp(-pi zeta / sqrt(1 - zeta^2)).
TEST(Response, SecondOrderStepOvershootsAsItsDampingSays) {
  const double zeta = 0.5, wn = 60.0, wd = wn * std::sqrt(1 - zeta * zeta);
  const auto v = answer(0.0, 3.0, [&](double t) {
    return 1.0 - std::exp(-zeta * wn * t) *
                     (std::cos(wd * t) + zeta / std::sqrt(1 - zeta * zeta) * std::sin(wd * t));
  });
  const double want = std::exp(-std::numbers::pi * zeta / std::sqrt(1 - zeta * zeta));
  EXPECT_TRUE(near(overshoot_ratio(record(v)), want, stated(5e-4, "peak between 1 ms samples")));
}

TEST(Response, ALinearRampIsExact) {
  const auto v = answer(0.0, 1.0, [](double t) { return std::min(t / 0.1, 1.0); });
  EXPECT_TRUE(near(rise_time_s(record(v)), 0.08, round_off(64, 1.0)));
  EXPECT_TRUE(near(response_time_s(record(v)), 0.09, round_off(64, 1.0)));
  EXPECT_TRUE(near(overshoot_ratio(record(v)), 0.0, round_off(64, 1.0)));
}

TEST(Response, AConstantHasNoRiseAndNoOvershoot) {
  const auto v = answer(0.1, 1.0, [](double) { return 0.1; });
  EXPECT_TRUE(std::isnan(rise_time_s(record(v))));
  EXPECT_TRUE(std::isnan(response_time_s(record(v))));
  EXPECT_TRUE(std::isnan(overshoot_ratio(record(v))));
}

TEST(Response, WithoutAReferenceBeforeTheCommandNothingIsMeasured) {
  auto v = answer(0.0, 1.0, [](double t) { return std::min(t / 0.1, 1.0); });
  EXPECT_TRUE(std::isnan(rise_time_s({v, 1'000'000, 199})));
  EXPECT_FALSE(std::isnan(rise_time_s({v, 1'000'000, 200})));
  EXPECT_TRUE(std::isnan(rise_time_s({v, 1'000'000, v.size() - 199})));
}

TEST(Response, NotANumberSpoilsEveryMetric) {
  auto v = answer(0.0, 1.0, [](double t) { return std::min(t / 0.1, 1.0); });
  v[kBefore + 950] = kNaN;
  for (double m : {rise_time_s(record(v)), response_time_s(record(v)), overshoot_ratio(record(v)),
                   mean(record(v)), maximum(record(v)), minimum(record(v)), quantile(v, 0.5),
                   rms_about(record(v), 0.0), final_mean(record(v))}) {
    EXPECT_TRUE(std::isnan(m));
  }
  v.back() = kNaN;
  EXPECT_TRUE(std::isnan(settled_s(record(v), 1.0, 0.1)));
  EXPECT_TRUE(std::isnan(settled_s(record(v), kNaN, 0.1)));
}

// A hole anywhere after the command may hide what would have counted: beyond the rise as well.
TEST(Response, AHoleAnywhereAfterTheCommandLeavesNothingToMeasure) {
  auto v = answer(0.0, 1.0, [](double t) { return std::min(t / 0.1, 1.0); });
  for (std::size_t at : {5, 50, 400}) {
    auto holed = v;
    holed[kBefore + at] = kNaN;
    for (double m : {rise_time_s(record(holed)), response_time_s(record(holed)),
                     overshoot_ratio(record(holed)), settled_s(record(holed), 1.0, 0.1),
                     change(record(holed))}) {
      EXPECT_TRUE(std::isnan(m)) << at;
    }
  }
  v[kBefore - 250] = kNaN;  // before the reference: nobody asks
  EXPECT_EQ(change(record(v)), 1.0);
}

TEST(Response, ChangeIsSignedAndNeedsTwoHundredMillisecondsOnEitherSide) {
  const auto v = answer(3.0, 1.0, [](double t) { return t < 0.1 ? 3.0 : 1.5; });
  EXPECT_EQ(change(record(v)), -1.5);
  EXPECT_TRUE(std::isnan(change({v, 1'000'000, 199})));
  EXPECT_TRUE(std::isnan(change(record(answer(2.0, 1.0, [](double) { return 2.0; })))));
}

TEST(Response, SettledIsTheLastEntryIntoTheBand) {
  const auto v = answer(0.0, 1.0, [](double t) {
    return t < 0.2 ? 0.0 : t < 0.5 ? 1.0 : t < 0.6 ? 2.0 : 1.0;
  });
  EXPECT_TRUE(near(settled_s(record(v), 1.0, 0.1), 0.6, round_off(4, 1.0)));
  EXPECT_EQ(settled_s(record(v), 1.0, 5.0), 0.0);
  const auto at_first = answer(0.0, 1.0, [](double t) { return t == 0.0 ? 0.0 : 1.0; });
  EXPECT_EQ(settled_s(record(at_first), 1.0, 0.1), 0.001);
  EXPECT_TRUE(std::isnan(settled_s(record(v), 3.0, 0.1)));
}

TEST(Response, RmsOfASineIsItsAmplitudeOverRootTwo) {
  const auto v =
      answer(0.0, 2.0, [](double t) { return 3.0 + 0.4 * std::sin(2 * std::numbers::pi * 5 * t); });
  EXPECT_TRUE(near(rms_about(record(v), 3.0), 0.4 / std::numbers::sqrt2, round_off(1000, 1.0)));
  EXPECT_TRUE(near(mean(record(v)), 3.0, round_off(1000, 3.0)));
  EXPECT_TRUE(near(maximum(record(v)), 3.4, round_off(10, 3.4)));
  EXPECT_TRUE(near(minimum(record(v)), 2.6, round_off(10, 3.4)));
}

TEST(Response, QuantilesOfTheFirstHundredIntegers) {
  std::vector<double> v;
  for (int i = 100; i >= 0; --i) v.push_back(i);
  EXPECT_EQ(quantile(v, 0.5), 50.0);
  EXPECT_EQ(quantile(v, 0.99), 99.0);
  EXPECT_EQ(quantile(v, 1.0), quantile(v, 0.99) + 1.0);
  EXPECT_TRUE(std::isnan(quantile(v, 1.005)));
  EXPECT_TRUE(std::isnan(quantile(v, -0.005)));
  EXPECT_TRUE(near(quantile(v, 0.005), 0.5, round_off(4, 1.0)));
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

}  // namespace
}  // namespace whirl::metrics
