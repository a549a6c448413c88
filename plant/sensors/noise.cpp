#include "plant/sensors/noise.hpp"

#include <algorithm>
#include <cmath>

#include "base/angles.hpp"

namespace whirl::plant {
namespace {

// Terms of equal variance, a decade apart, add up to B^2 / (2 pi f) with this deviation each.
double term_deviation(double instability) {
  return instability * std::sqrt(std::log(10.0) / kPi);
}

constexpr double kFlickerGrain_s = 0.01;  // its fastest term takes 1 s

}  // namespace

double WhiteNoise::sample(double dt_s) {
  return density_ == 0.0 ? 0.0 : density_ / std::sqrt(dt_s) * stream_.normal();
}

GaussMarkov::GaussMarkov(double deviation, double time_s, std::uint64_t seed,
                         const std::string& name)
    : deviation_(deviation), time_s_(time_s), stream_(seed, name) {
  value_ = deviation_ * stream_.normal();
}

double GaussMarkov::step(double dt_s) {
  if (deviation_ == 0.0) return 0.0;
  const double fade = std::exp(-dt_s / time_s_);
  value_ = fade * value_ + deviation_ * std::sqrt(1.0 - fade * fade) * stream_.normal();
  return value_;
}

// Behind the first lag the variance is 2 deviation^2, behind the second deviation^2, which is the
// covariance of the two as well.
SmoothWander::SmoothWander(double deviation, double time_s, std::uint64_t seed,
                           const std::string& name)
    : deviation_(deviation), lag_s_(0.5 * time_s), stream_(seed, name) {
  value_ = deviation_ * stream_.normal();
  driver_ = value_ + deviation_ * stream_.normal();
}

double SmoothWander::step(double dt_s) {
  if (deviation_ == 0.0) return 0.0;
  const double d = dt_s / lag_s_, fade = std::exp(-d), fade2 = fade * fade;
  // What the step adds: the stationary covariances less what is left of them.
  const double driver_variance = 2.0 * (1.0 - fade2), shared = 1.0 - fade2 * (1.0 + 2.0 * d),
               variance = 1.0 - fade2 * (1.0 + 2.0 * d * (1.0 + d));
  if (!(driver_variance > 0.0)) return value_;
  const double first = deviation_ * stream_.normal(), second = deviation_ * stream_.normal();
  const double by_first = shared / std::sqrt(driver_variance);
  value_ = fade * (value_ + d * driver_) + by_first * first +
           std::sqrt(std::max(0.0, variance - by_first * by_first)) * second;
  driver_ = fade * driver_ + std::sqrt(driver_variance) * first;
  return value_;
}

Flicker::Flicker(double instability, std::uint64_t seed, const std::string& name)
    : terms_{GaussMarkov(term_deviation(instability), 1.0, seed, name + ".1s"),
             GaussMarkov(term_deviation(instability), 10.0, seed, name + ".10s"),
             GaussMarkov(term_deviation(instability), 100.0, seed, name + ".100s"),
             GaussMarkov(term_deviation(instability), 1000.0, seed, name + ".1000s")} {}

double Flicker::step(double dt_s) {
  waiting_s_ += dt_s;
  double sum = 0.0;
  const bool due = waiting_s_ >= kFlickerGrain_s;
  for (GaussMarkov& term : terms_) sum += due ? term.step(waiting_s_) : term.value();
  if (due) waiting_s_ = 0.0;
  return sum;
}

double draw_normal(double deviation, std::uint64_t seed, const std::string& name) {
  return deviation * RandomStream(seed, name).normal();
}

double draw_uniform(double low, double high, std::uint64_t seed, const std::string& name) {
  return low + (high - low) * RandomStream(seed, name).uniform();
}

}  // namespace whirl::plant
