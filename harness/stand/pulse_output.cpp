#include "harness/stand/pulse_output.hpp"

#include <cmath>

namespace whirl::stand {
namespace {

constexpr double kZero_us = 1000.0, kLow_us = 1100.0, kHigh_us = 1950.0;
constexpr double kLast_setpoint = 2047.0;

std::int64_t period_ns(double rate_Hz) {
  return std::llround(1e9 / rate_Hz);
}

}  // namespace

void PulseOutput::follow(std::uint16_t v, bool silent, double rate_Hz) {
  const std::int32_t wanted = silent ? -1 : v;
  if (wanted == followed_) return;
  followed_ = wanted;
  const double share = (v - 1) / (kLast_setpoint - 1.0);
  const double width_us = v == 0 ? kZero_us : kLow_us + share * (kHigh_us - kLow_us);
  train_ = {};
  train_.width_ns = silent ? 0 : std::llround(width_us * 1e3);
  train_.period_ns = period_ns(rate_Hz);
  fresh_ = true;
}

void PulseOutput::set(const request::Pulses& pulses) {
  train_ = {};
  train_.width_ns = pulses.width_ns;
  train_.period_ns = pulses.period_ns;
  train_.glitch_ns = pulses.glitch_ns;
  train_.glitch_after_ns = pulses.glitch_after_ns;
  fresh_ = true;
}

void PulseOutput::send(std::int64_t t_ns, io::Batch& sensed) {
  if (!fresh_) return;
  sensed.add(io::Kind::pulse_train, motor_, t_ns, train_);
  fresh_ = false;
}

}  // namespace whirl::stand
