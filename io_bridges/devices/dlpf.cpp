#include "io_bridges/devices/dlpf.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/check.hpp"

namespace whirl::io {
namespace {

// Of two equal poles, -3 dB at w = 1: each has tau = sqrt(sqrt(2) - 1).
const double kEqualPolesDelay = 2.0 * std::sqrt(std::numbers::sqrt2 - 1.0);

double blend(double step_s, double tau_s) {
  return tau_s > 0.0 ? -std::expm1(-step_s / tau_s) : 1.0;
}

}  // namespace

Dlpf::Dlpf(double bandwidth_Hz, double delay_s, double step_s) {
  WHIRL_CHECK(bandwidth_Hz > 0.0 && delay_s >= 0.0 && step_s > 0.0, bandwidth_Hz, delay_s, step_s);
  const double w_radps = 2.0 * std::numbers::pi * bandwidth_Hz;
  const double sum = std::clamp(delay_s * w_radps, 1.0, kEqualPolesDelay);  // (t1 + t2) w
  // (1 + t1^2 w^2)(1 + t2^2 w^2) = 2 with p = t1 t2 w^2 gives p^2 - 2 p + sum^2 - 1 = 0.
  const double product = 1.0 - std::sqrt(2.0 - sum * sum);
  const double spread = std::sqrt(std::max(0.0, sum * sum - 4.0 * product));
  first_blend_ = blend(step_s, 0.5 * (sum + spread) / w_radps);
  second_blend_ = blend(step_s, 0.5 * (sum - spread) / w_radps);
  const auto lag_steps = [](double b) { return (1.0 - b) / b; };  // of y += b (x - y)
  const double rest = delay_s / step_s - lag_steps(first_blend_) - lag_steps(second_blend_);
  delay_steps_ = static_cast<std::size_t>(
      std::clamp(std::round(rest), 0.0, static_cast<double>(kMaxDelaySteps)));
}

double Dlpf::step(double input) {
  held_[next_] = input;
  const std::size_t ring = delay_steps_ + 1;
  next_ = (next_ + 1) % ring;
  first_ += first_blend_ * (held_[next_ % ring] - first_);
  second_ += second_blend_ * (first_ - second_);
  return second_;
}

void Dlpf::settle(double input) {
  held_.fill(input);
  first_ = second_ = input;
}

}  // namespace whirl::io
