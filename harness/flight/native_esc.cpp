#include "harness/flight/native_esc.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "firmware/esc/core/still_air.hpp"
#include "harness/flight/controllers.hpp"
#include "harness/flight/flight_params.hpp"

namespace whirl::flight {
namespace {

constexpr std::int64_t kTick_ns = 1'000'000;
constexpr double kStanding_s =
    15e-3;  // without a crossing, at the terminals of a bridge that is off
constexpr double kBackward_radps = -20.0;  // slower, it shows nothing for that time
constexpr int kBrake_ms = 200;             // how much longer it is aligned then, as the image does
constexpr int kHeld_ms = 161;              // alignment and forced steps, see Start
constexpr int kStarting_ms = 300;          // a start that has not caught on by then is begun anew
// The ESC32v2: 12 bits of 3.3 V behind 1.5/11.5 dividers and a shunt of 0.5 mohm with gain 50.9.
constexpr double kVolts_per_count = 3.3 / 4096.0 * 11.5 / 1.5;
constexpr double kAmperes_per_count = 3.3 / 4096.0 / (0.5e-3 * 50.9);
constexpr int kSamples = 20;          // per tick: one in each PWM period
constexpr double kPwm_counts = 3600;  // 72 MHz / 20 kHz
// Of a motor that it turns: the image's bridge switches the upper transistor alone.
constexpr plant::Freewheel kFreewheel = plant::Freewheel::diode;

double converted(double volts_or_amperes, double per_count) {
  return std::clamp(std::floor(volts_or_amperes / per_count), 0.0, 4095.0) * per_count;
}

}  // namespace

NativeEsc::NativeEsc(const EscParams& params, std::uint64_t seed, int number)
    : core_(params.calibration),
      shunt_(params.shunt, seed, "esc" + std::to_string(number) + ".shunt"),
      crossings_(params.pole_pairs) {}

float NativeEsc::sample_current(double bus_current_A) {
  double sum_A = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    shunt_.flow(bus_current_A, 1e-9 * static_cast<double>(kTick_ns) / kSamples);
    sum_A += converted(shunt_.sample_A(), kAmperes_per_count);
  }
  return static_cast<float>(sum_A / kSamples);
}

fw::esc::Sensed NativeEsc::sense(std::int64_t now_ns, const plant::MotorState& motor,
                                 double bus_voltage_V) {
  crossings_.turn(now_ns - kTick_ns, now_ns, last_speed_radps_, motor.speed_radps);
  last_speed_radps_ = motor.speed_radps;
  const fw::esc::Pace pace = phase_ == Phase::turning ? crossings_.pace() : fw::esc::Pace{};
  fw::esc::Sensed sensed;
  sensed.bus_voltage_V = static_cast<float>(converted(bus_voltage_V, kVolts_per_count));
  sensed.bus_current_A = sample_current(motor.bus_current_A);
  sensed.in_sync = pace.revolution > 0;
  sensed.speed_radps = speed_.update(crossings_.radps(pace.revolution, 6), sensed.in_sync);
  sensed.slowing = pace.slowing;
  sensed.latest_radps = crossings_.radps(pace.sector, 1);
  sensed.recent_radps = crossings_.radps(pace.four, 4);
  return sensed;
}

void NativeEsc::enter(Phase phase) {
  phase_ = phase;
  phase_ms_ = 0;
  followed_ = false;
}

// The bridge driver of the image, as far as an averaged motor can have one.
void NativeEsc::follow(bool energised) {
  if (!energised) return enter(Phase::off);
  ++phase_ms_;
  switch (phase_) {
    case Phase::off:
      crossings_.restart();
      return enter(Phase::catching);
    case Phase::catching:
      if (crossings_.in_sync()) return enter(Phase::turning);
      if (crossings_.silent_s() <= kStanding_s) return;
      backward_ = last_speed_radps_ < kBackward_radps;
      enter(Phase::aligning);
      return;
    case Phase::aligning:
      if (phase_ms_ < (backward_ ? kHeld_ms + kBrake_ms : kHeld_ms)) return;
      crossings_.restart();
      return enter(Phase::turning);
    case Phase::turning:
      if (crossings_.in_sync()) {
        followed_ = true;
        phase_ms_ = 0;
      } else if (followed_ || phase_ms_ > kStarting_ms) {
        enter(Phase::catching);
      }
      return;
  }
}

plant::MotorCommand NativeEsc::step(std::int64_t now_ns, const plant::MotorState& motor,
                                    double bus_voltage_V) {
  if (fresh_) core_.on_setpoint(setpoint_);
  fresh_ = false;
  fw::esc::Sensed sensed = sense(now_ns, motor, bus_voltage_V);
  if (cut_) core_.latch(fw::esc::Latched::desync);
  if (phase_ != Phase::off) {
    zero_.turns();
  } else if (core_.at_rest()) {
    zero_.record(sensed.bus_current_A);
  }
  sensed.bus_current_A -= zero_.offset_A();

  const fw::esc::Drive drive = core_.tick(sensed);
  follow(drive.energised);
  if (phase_ == Phase::aligning && backward_) return {0.0, plant::Freewheel::synchronous};
  if (phase_ != Phase::turning) return {};
  const double duty = std::clamp(static_cast<double>(drive.duty), 0.0, 1.0);
  return {std::floor(duty * kPwm_counts) / kPwm_counts, kFreewheel};
}

std::optional<double> NativeEsc::take_still_air(const std::function<void()>& tick) {
  using Answer = fw::esc::StillAir::Answer;
  fw::esc::StillAir air;
  air.begin();
  Answer answer = Answer::measuring;
  while (answer == Answer::measuring) {
    tick();
    answer = air.sample(core_);
  }
  if (answer == Answer::refused) return {};
  core_.take_still_power(air.share());
  return static_cast<double>(air.share());
}

io::EscState NativeEsc::status() const {
  return {static_cast<double>(core_.bus_current_A()),
          static_cast<double>(core_.speed_radps() / fw::esc::kRadps_per_rpm),
          core_.flags(),
          {}};
}

std::vector<MotorController::NamedValue> NativeEsc::signals() const {
  const auto thrust_N = [this] { return static_cast<double>(core_.estimator().thrust_N()); };
  const auto observable = [this] { return core_.estimator().observable() ? 1.0 : 0.0; };
  return {{{"esc_thrust", Dimension::force, "as the ESC's core believes"}, thrust_N},
          {{"esc_observable", Dimension::none, "1: power tells it the inflow"}, observable}};
}

ControllerType native_esc_type() {
  return {"esc_core", kFreewheel,
          [](const FlightParams& params, std::uint64_t seed,
             int number) -> std::unique_ptr<MotorController> {
            return std::make_unique<NativeEsc>(params.esc_of(number), seed, number);
          }};
}

}  // namespace whirl::flight
