#include "harness/metrics/response.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "base/near.hpp"

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

// What an instrument's rows look like: each value stands from the row at which it is known until the next one.
struct Held {
  std::vector<double> values;
  std::vector<std::int64_t> ages_ns;
  Record record(bool with_ages) const {
    return {values, 1'000'000, kBefore,
            with_ages ? std::span(ages_ns) : std::span<const std::int64_t>()};
  }
};

// f(t after the command), measured each `every_ms` from `first_ms` on, and known so long afterwards.
Held held(double every_ms, double first_ms, double known_ms,
          const std::function<double(double)>& f) {
  Held all;
  double measured_ms = first_ms;
  for (int row = -static_cast<int>(kBefore); row < 1000; ++row) {
    while (measured_ms + every_ms + known_ms <= row) measured_ms += every_ms;
    all.values.push_back(f(measured_ms * 1e-3));
    all.ages_ns.push_back(std::llround((row - measured_ms) * 1e6));
  }
  return all;
}

// 17 ms of a rise, by a cell of 500 readings a second, wherever they fall: the rows that hold them tell up to 2 ms of
// it, their times tell it as a line between two readings can.
TEST(Response, OfHeldReadingsTheirTimesCount) {
  const double tau = 0.017 / std::log(9.0), want = 0.017;
  const auto rise = [&](double t) { return t < 0.0 ? 2.0 : 3.2 - 1.2 * std::exp(-t / tau); };
  double worst_held = 0.0;
  for (double phase_ms = 0.0; phase_ms < 2.0; phase_ms += 0.13) {
    for (const double known_ms : {0.2, 1.7}) {
      const Held v = held(2.0, -400.0 + phase_ms, known_ms, rise);
      worst_held = std::max(worst_held, std::abs(rise_time_s(v.record(false)) - want));
      EXPECT_TRUE(near(rise_time_s(v.record(true)), want,
                       stated(3e-4, "chords of 2 ms, one over the kink at the command")))
          << phase_ms;
      EXPECT_TRUE(near(response_time_s(v.record(true)), tau * std::log(10.0),
                       stated(1.5e-4, "a chord of 2 ms on an exponential: h^2/8 tau")));
    }
  }
  EXPECT_GT(worst_held, 5e-4);
}

TEST(Response, AReadingThatCrossesLateIsNotBeforeTheCommand) {
  std::vector<double> values(kBefore, 0.0);
  values.push_back(0.0);
  for (int i = 0; i < 400; ++i) values.push_back(1.0);
  const std::vector<std::int64_t> ages_ns(values.size(), 5'000'000);
  const Record old{values, 1'000'000, kBefore, ages_ns};
  EXPECT_EQ(response_time_s(old), 0.0);
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

// Without a single value there is no metric, wherever the command is said to lie.
TEST(Response, NothingAfterTheCommandIsNothingToMeasure) {
  const std::vector<double> v(300, 1.0);
  for (std::size_t command : {v.size(), v.size() + 1}) {
    const Record none{v, 1'000'000, command};
    for (double m : {rise_time_s(none), response_time_s(none), overshoot_ratio(none), change(none),
                     settled_s(none, 1.0, 9.0), mean(none), final_mean(none), minimum(none),
                     maximum(none), rms_about(none, 0.0)}) {
      EXPECT_TRUE(std::isnan(m));
    }
  }
}

TEST(Response, FinalIsTheMeanOfTheLastTwoHundredMilliseconds) {
  const auto v = answer(0.0, 1.0, [](double t) {
    return t < 0.7995 ? 5.0 : t < 0.8995 ? 1.0 : 3.0;
  });
  EXPECT_EQ(final_mean(record(v)), 2.0);
  const std::size_t last_200 = v.size() - 200;
  EXPECT_EQ(final_mean({v, 1'000'000, last_200}), 2.0);
  EXPECT_TRUE(std::isnan(final_mean({v, 1'000'000, last_200 + 1})));
  EXPECT_EQ(change({v, 1'000'000, last_200}), 2.0 - 5.0);
  EXPECT_TRUE(std::isnan(change({v, 1'000'000, last_200 + 1})));
  EXPECT_EQ(final_mean({v, 2'000'000, kBefore}), 3.0);  // of steps twice as long, half as many
}

TEST(Response, AReferenceIsOfTheTwoHundredMillisecondsBeforeTheCommand) {
  auto v = answer(1.0, 1.0, [](double) { return 9.0; });
  for (std::size_t i = 0; i < kBefore - 200; ++i) v[i] = 1e6;
  EXPECT_EQ(change(record(v)), 8.0);
  v[kBefore - 200] = 201.0;
  EXPECT_TRUE(near(change(record(v)), 7.0, round_off(8, 9.0)));
}

// A step longer than the reference leaves no value in it.
TEST(Response, StepsLongerThanTheReferenceGiveNoChange) {
  const auto v = answer(0.0, 1.0, [](double) { return 1.0; });
  EXPECT_TRUE(std::isnan(change({v, 200'000'001, kBefore})));
  EXPECT_EQ(change({v, 200'000'000, kBefore}), 1.0);
}

TEST(Response, AChangeIsMoreThanABillionthOfTheValues) {
  const auto change_to = [](double from, double to) {
    return change(record(answer(from, 1.0, [=](double) { return to; })));
  };
  EXPECT_TRUE(std::isnan(change_to(1.0, 1.0 + 0.995e-9)));
  EXPECT_TRUE(near(change_to(1.0, 1.0 + 1.005e-9), 1.005e-9, round_off(400, 1.0)));
  EXPECT_TRUE(near(change_to(-1.0 - 1.005e-9, -1.0), 1.005e-9, round_off(400, 1.0)));
  EXPECT_TRUE(std::isnan(change_to(0.0, 0.0)));
  EXPECT_TRUE(std::isnan(response_time_s(record(answer(0.0, 1.0, [](double) { return 0.0; })))));
  EXPECT_TRUE(near(change_to(0.0, 1e-12), 1e-12, round_off(400, 1e-12)));  // from nothing
}

TEST(Response, SmallChangesRiseAndFallLikeLargeOnes) {
  for (double size : {0.25, 0.5, 8.0}) {
    const auto ramp = [=](double t) { return size * std::min(t / 0.125, 1.0); };
    const auto up = answer(0.0, 1.0, ramp);
    const auto down = answer(size, 1.0, [=](double t) { return size - ramp(t); });
    EXPECT_TRUE(near(rise_time_s(record(up)), 0.1, round_off(256, 1.0))) << size;
    EXPECT_TRUE(near(fall_time_s(record(down)), 0.1, round_off(256, 1.0))) << size;
    EXPECT_TRUE(near(response_time_s(record(down)), 0.1125, round_off(256, 1.0))) << size;
    EXPECT_TRUE(std::isnan(fall_time_s(record(up)))) << size;
    EXPECT_TRUE(std::isnan(rise_time_s(record(down)))) << size;
  }
}

TEST(Response, WhatIsThereAtTheCommandTookNoTime) {
  const auto v = answer(0.0, 1.0, [](double) { return 5.0; });
  EXPECT_EQ(response_time_s(record(v)), 0.0);
  EXPECT_EQ(rise_time_s(record(v)), 0.0);
}

// 0.9 of the way from 0 to 10, and it rests there.
TEST(Response, AValueOnTheLevelHasReachedIt) {
  const auto v = answer(0.0, 1.0, [](double t) { return t < 0.1 ? 0.0 : t < 0.3 ? 9.0 : 10.0; });
  EXPECT_TRUE(near(response_time_s(record(v)), 0.1, round_off(4, 1.0)));
  const auto w = answer(10.0, 1.0, [](double t) { return t < 0.1 ? 10.0 : t < 0.3 ? 1.0 : 0.0; });
  EXPECT_TRUE(near(response_time_s(record(w)), 0.1, round_off(4, 1.0)));
}

// 0.3 and 0.2 of the change beyond where it ends, upwards and downwards.
TEST(Response, OvershootIsAShareOfTheChangeInItsDirection) {
  const auto up = answer(1.0, 1.0, [](double t) { return t < 0.1 ? 5.0 + 1.2 : 5.0; });
  EXPECT_TRUE(near(overshoot_ratio(record(up)), 0.3, round_off(64, 1.0)));
  const auto down = answer(5.0, 1.0, [](double t) { return t < 0.1 ? 1.0 - 0.8 : 1.0; });
  EXPECT_TRUE(near(overshoot_ratio(record(down)), 0.2, round_off(64, 1.0)));
}

TEST(Response, TheEdgeOfABandBelongsToIt) {
  const auto v = answer(0.0, 1.0, [](double t) { return t < 0.1 ? 0.0 : t < 0.3 ? 1.5 : 1.0; });
  EXPECT_TRUE(near(settled_s(record(v), 1.0, 0.5), 0.1, round_off(4, 1.0)));
  EXPECT_EQ(settled_s(record(v), 1.0, 1.0), 0.0);
  const auto late = answer(0.0, 1.0, [](double t) { return t < 0.9985 ? 0.0 : 1.0; });
  EXPECT_TRUE(near(settled_s(record(late), 1.0, 0.5), 0.999, round_off(4, 1.0)));
  EXPECT_TRUE(std::isnan(settled_s(record(v), 1.0, kNaN)));
}

TEST(Response, OfOneValueEveryQuantileIsThatValue) {
  for (double p : {0.0, 0.5, 1.0}) EXPECT_EQ(quantile(std::vector<double>{7.0}, p), 7.0);
  EXPECT_EQ(quantile(std::vector<double>{3.0, 1.0}, 0.0), 1.0);
  EXPECT_EQ(quantile(std::vector<double>{3.0, 1.0}, 1.0), 3.0);
  EXPECT_EQ(quantile(std::vector<double>{3.0, 1.0}, 0.25), 1.5);
}

}  // namespace
}  // namespace whirl::metrics
