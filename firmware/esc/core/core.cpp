#include "firmware/esc/core/core.hpp"

#include "firmware/esc/core/thrust_demand.hpp"

namespace fw::esc {
namespace {

constexpr float kStart_V = 2.0f;             // below, the rotor turns too slowly to be sensed
constexpr float kLeast_V = 0.6f;             // a shorter on-time would leave nothing to sample
constexpr float kHeld_radps = 100.0f;        // whatever the duty: slower, and commutation gets lost
constexpr float kSlowest_radps = 60.0f;      // under this, speed control has nothing to hold on to
constexpr std::uint16_t kStart_ms = 1500;    // longest start-up before it counts as a stall
constexpr std::uint16_t kRestart_ms = 1500;  // after synchronism was lost
constexpr std::uint8_t kLosses = 5;          // with less than the time below between them
constexpr std::uint16_t kCalm_ms = 2000;
constexpr float kOverCurrent_A = 22.0f;  // of the bus, averaged
constexpr std::uint16_t kOverCurrent_ms = 3;
constexpr float kLowest_V = 12.0f;  // 3 V a cell under load
constexpr float kStatusFilter_s = 0.01f;

float clamped(float x, float low, float high) {
  return x < low ? low : x > high ? high : x;
}

// Of the highest current. A slow rotor under all of it would gain an eighth of its speed from one
// crossing to the next, and commutation come late.
float share_at(float speed_radps) {
  return clamped((speed_radps - 40.0f) / 120.0f, kHeld_share, 1.0f);
}

}  // namespace

Core::Core(const Calibration& calibration)
    : calibration_(calibration),
      supervisor_({.arming_voltage_V = calibration.arming_voltage_V}),
      estimator_(calibration, kPeriod_s),
      speed_control_(calibration.motor_within_limits(), calibration.free_air, SpeedGains{},
                     kPeriod_s, calibration.identified) {}

void Core::on_setpoint(std::uint16_t v) {
  command_given_ = false;
  supervisor_.on_setpoint(v, sensed_.bus_voltage_V, at_rest());
}

bool Core::command(Mode mode, float value) {
  const Range range = range_of(mode);
  const bool stop = !(value > 0.0f);
  if (!stop && mode != calibration_.mode && !set_mode(mode)) return false;
  supervisor_.on_setpoint(stop ? 0 : 1, sensed_.bus_voltage_V, at_rest());
  command_given_ = !stop;
  command_value_ = clamped(value, range.min, range.max);
  return true;
}

void Core::arm_by_hand() {
  for (unsigned i = 0; i < SupervisorLimits{}.zeros_to_arm; ++i) on_setpoint(0);
}

bool Core::recalibrate(const Calibration& calibration) {
  if (!at_rest() || drive_.energised) return false;
  const Mode mode = calibration_.mode;
  calibration_ = calibration;
  calibration_.mode = mode;
  supervisor_.limit({.arming_voltage_V = calibration.arming_voltage_V});
  estimator_ = ThrustEstimator(calibration_, kPeriod_s);
  speed_control_ = SpeedController(calibration.motor_within_limits(), calibration.free_air,
                                   SpeedGains{}, kPeriod_s, calibration.identified);
  return true;
}

void Core::take_still_power(float share) {
  calibration_.free_air.take_still_power(share);
  estimator_.take_still_power(share);
  speed_control_.take_still_power(share);
}

bool Core::set_mode(Mode mode) {
  if (!at_rest() || range_of(mode).max <= 0.0f) return false;
  calibration_.mode = mode;
  return true;
}

float Core::wanted_value() const {
  if (supervisor_.setpoint() == 0) return 0.0f;
  return command_given_ ? command_value_ : value_of(calibration_.mode, supervisor_.setpoint());
}

// The speed that gives the wanted value: by the static map, or by what the estimator has found.
float Core::speed_for(float value) const {
  const StaticMap& map = calibration_.free_air;
  switch (calibration_.mode) {
    case Mode::speed:
      return value;
    case Mode::thrust_by_speed:
      return speed_for_thrust_radps(map, value, 1.0f, solved_radps_);
    case Mode::power:
      return speed_for_power_radps(map, value, estimator_.power_ratio(), solved_radps_);
    case Mode::thrust_by_power:
      return speed_for_thrust_radps(map, value, estimator_.thrust_ratio(), solved_radps_);
    case Mode::duty:
    case Mode::servo:
      return 0.0f;
  }
  return 0.0f;
}

void Core::enter(Phase phase) {
  if (phase == Phase::starting) {
    losses_ = 0;
    solved_radps_ = 0.0f;
    speed_control_.restart();
    estimator_.restart(sensed_.speed_radps);
  }
  phase_ = phase;
  phase_ms_ = 0;
}

void Core::advance_phase(bool wanted) {
  const bool seen = sensed_.in_sync && sensed_.speed_radps > kSlowest_radps;
  if (phase_ms_ < UINT16_MAX) ++phase_ms_;
  if (!wanted) {
    if (phase_ != Phase::stopped) enter(Phase::stopped);
    return;
  }
  switch (phase_) {
    case Phase::stopped:
      return enter(Phase::starting);
    case Phase::starting:
      if (seen) return enter(Phase::running);
      if (phase_ms_ > kStart_ms) supervisor_.latch(Latched::stalled);
      return;
    case Phase::running:
      if (phase_ms_ == kCalm_ms) losses_ = 0;
      if (seen) return;
      enter(Phase::lost);
      if (++losses_ > kLosses) supervisor_.latch(Latched::desync);
      return;
    case Phase::lost:
      if (seen) return enter(Phase::running);
      if (phase_ms_ > kRestart_ms) supervisor_.latch(Latched::desync);
      return;
  }
}

Drive Core::drive_for_phase(float value) {
  switch (phase_) {
    case Phase::stopped:
      return {};
    case Phase::starting:
    case Phase::lost:  // the driver catches the rotor, or starts it anew
      return {kStart_V / sensed_.bus_voltage_V, true};
    case Phase::running:
      return regulate(value);
  }
  return {};
}

Drive Core::regulate(float value) {
  const float bus_V = sensed_.bus_voltage_V;
  const float latest_radps =
      sensed_.latest_radps >= 0.0f ? sensed_.latest_radps : sensed_.speed_radps;
  const float share = sensed_.slowing ? kHeld_share : share_at(latest_radps);
  VoltageDemand demand{};
  if (calibration_.mode == Mode::duty) {
    demand = within_current_limits(calibration_.motor_within_limits(), value * bus_V, latest_radps,
                                   bus_V, share);
    // At little duty the current has gaps and the rotor would slow down until nothing is sensed.
    const float held_V =
        speed_control_.update(kHeld_radps, {latest_radps, latest_radps}, bus_V, share).voltage_V;
    if (demand.voltage_V < held_V) demand = {held_V, true};
  } else {
    wanted_radps_ = solved_radps_ = speed_for(value);
    if (wanted_radps_ < kSlowest_radps) wanted_radps_ = kSlowest_radps;
    const float recent_radps = sensed_.recent_radps >= 0.0f ? sensed_.recent_radps : latest_radps;
    demand = speed_control_.update(wanted_radps_, {recent_radps, latest_radps}, bus_V, share);
  }
  if (demand.voltage_V < kLeast_V) demand = {kLeast_V, true};
  saturated_ = demand.saturated;
  return {demand.voltage_V / bus_V, true};
}

void Core::guard(const Sensed& sensed) {
  const bool over = bus_current_A_ > kOverCurrent_A;
  over_current_ms_ = over ? static_cast<std::uint16_t>(over_current_ms_ + 1) : std::uint16_t{0};
  if (over_current_ms_ >= kOverCurrent_ms) supervisor_.latch(Latched::over_current);
  if (drive_.energised && sensed.bus_voltage_V < kLowest_V) {
    supervisor_.latch(Latched::under_voltage);
  }
}

Drive Core::tick(const Sensed& sensed) {
  sensed_ = sensed;
  supervisor_.tick();
  const CurrentSense& sense = calibration_.sense;
  const float bus_A = sense.gain * (sensed.bus_current_A - sense.offset_A);
  measured_A_ = bus_A;
  bus_current_A_ += kPeriod_s / (kStatusFilter_s + kPeriod_s) * (bus_A - bus_current_A_);
  guard(sensed);

  offset_error_.tick(!drive_.energised);
  if (drive_.energised && drive_.duty > 0.01f) {
    estimator_.update(sensed.bus_voltage_V, drive_.duty, bus_A, sensed.speed_radps,
                      offset_error_.amperes(sense.warm_up_A));
  }
  saturated_ = false;
  wanted_radps_ = 0.0f;
  const bool powered = sensed.bus_voltage_V > kStart_V;
  advance_phase(powered && wanted_value() > 0.0f);
  const float value = wanted_value();  // 0 if the phase has just latched a fault
  drive_ = value > 0.0f ? drive_for_phase(value) : Drive{};
  return drive_;
}

std::uint8_t Core::flags() const {
  std::uint8_t flags = 0;
  if (supervisor_.armed()) flags |= flag_armed;
  if (!at_rest()) flags |= flag_turning;
  if (saturated_) flags |= flag_saturated;
  const Latched latched = supervisor_.latched();
  if (latched == Latched::over_current) flags |= flag_over_current;
  if (latched == Latched::under_voltage || supervisor_.refused_for_voltage()) {
    flags |= flag_under_voltage;
  }
  if (latched == Latched::desync || latched == Latched::stalled || phase_ == Phase::lost) {
    flags |= flag_desync;
  }
  // Thrust and power are read off the current, on which there is no reliance while its zero drifts.
  const bool cold =
      goes_by_power(calibration_.mode) && !offset_error_.settled(calibration_.sense.warm_up_A);
  if (!calibration_.identified || cold) flags |= flag_uncalibrated;
  return flags;
}

}  // namespace fw::esc
