#include "harness/flight/native_esc.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace whirl::flight {
namespace {

constexpr std::int64_t kTick_ns = 1'000'000;
constexpr int kHeld_ms = 185;  // alignment and forced steps, see Start
// The ESC32v2: 12 bits of 3.3 V behind 1.5/11.5 dividers and a shunt of 0.5 mohm with gain 50.9.
constexpr double kVolts_per_count = 3.3 / 4096.0 * 11.5 / 1.5;
constexpr double kAmperes_per_count = 3.3 / 4096.0 / (0.5e-3 * 50.9);
constexpr int kSamples = 20;          // per tick: one in each PWM period
constexpr double kPwm_counts = 3600;  // 72 MHz / 20 kHz
constexpr double kTrip_A = 24.0;
constexpr int kTripSamples = 3;

double counts(double volts_or_amperes, double per_count) {
  return std::clamp(std::floor(volts_or_amperes / per_count), 0.0, 4095.0);
}

}  // namespace

NativeEsc::NativeEsc(const EscParams& params, std::uint64_t seed, int number)
    : core_(params.calibration),
      shunt_(params.shunt, seed, "esc" + std::to_string(number) + ".shunt"),
      crossings_(params.pole_pairs) {}

// The mean of a tick's samples; the bridge's own trip looks at each of them.
float NativeEsc::sense_current(double bus_current_A) {
  double sum_A = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    shunt_.flow(bus_current_A, 1e-9 * static_cast<double>(kTick_ns) / kSamples);
    const double sample_A = counts(shunt_.sample_A(), kAmperes_per_count) * kAmperes_per_count;
    sum_A += sample_A;
    over_ =
        energised_ && sample_A - static_cast<double>(zero_.offset_A()) > kTrip_A ? over_ + 1 : 0;
    if (over_ >= kTripSamples) tripped_ = true;
  }
  return static_cast<float>(sum_A / kSamples);
}

bool NativeEsc::following() const {
  return energised_ && energised_ms_ > kHeld_ms;
}

plant::MotorCommand NativeEsc::step(std::int64_t now_ns, const plant::MotorState& motor,
                                    double bus_voltage_V) {
  if (following()) {
    crossings_.turn(now_ns - kTick_ns, now_ns, last_speed_radps_, motor.speed_radps);
  } else {
    crossings_.restart();
  }
  last_speed_radps_ = motor.speed_radps;
  const bool in_sync = crossings_.in_sync();

  if (fresh_) core_.on_setpoint(setpoint_);
  fresh_ = false;
  fw::esc::Sensed sensed;
  sensed.bus_voltage_V =
      static_cast<float>(counts(bus_voltage_V, kVolts_per_count) * kVolts_per_count);
  sensed.bus_current_A = sense_current(motor.bus_current_A);
  sensed.speed_radps = speed_.update(static_cast<float>(crossings_.speed_radps()), in_sync);
  sensed.in_sync = in_sync;
  if (tripped_) core_.latch(fw::esc::Latched::over_current);
  tripped_ = false;
  if (cut_) core_.latch(fw::esc::Latched::desync);
  if (!energised_ && core_.at_rest()) zero_.note(sensed.bus_current_A);
  sensed.bus_current_A -= zero_.offset_A();

  const fw::esc::Drive drive = core_.tick(sensed);
  energised_ms_ = drive.energised ? energised_ms_ + 1 : 0;
  energised_ = drive.energised;
  if (!following()) return {};
  const double duty = std::clamp(static_cast<double>(drive.duty), 0.0, 1.0);
  return {std::floor(duty * kPwm_counts) / kPwm_counts, plant::Freewheel::diode};
}

io::EscState NativeEsc::status() const {
  return {static_cast<double>(core_.bus_current_A()),
          static_cast<double>(core_.speed_radps() / fw::esc::kRadps_per_rpm),
          core_.flags(),
          {}};
}

}  // namespace whirl::flight
