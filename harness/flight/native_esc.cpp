#include "harness/flight/native_esc.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "harness/base/check.hpp"

namespace whirl::flight {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr double kRpm_per_radps = 30.0 / std::numbers::pi;
constexpr double kTurning_radps = 30.0;

}  // namespace

NativeEsc::NativeEsc(const EscParams& params) : params_(params) {
  WHIRL_CHECK(params.mode == io::EscMode::duty || params.mode == io::EscMode::rpm ||
              params.mode == io::EscMode::thrust_by_rpm);
}

void NativeEsc::write(std::uint16_t v, bool valid, std::int64_t t_ns) {
  if (!valid) return;
  last_valid_ns_ = t_ns;
  v_ = v;
  zeros_ = v == 0 ? zeros_ + 1 : 0;
  if (zeros_ < params_.arming_zeros) return;
  if (trouble_ != Trouble::cut) trouble_ = Trouble::none;  // a row of zeros clears a latched fault
  const bool at_rest = speed_radps_ < kTurning_radps;
  if (at_rest && trouble_ == Trouble::none && bus_voltage_V_ >= params_.arming_voltage_V) {
    armed_ = true;
  }
}

void NativeEsc::cut() {
  trouble_ = Trouble::cut;
  disarm();
}

void NativeEsc::disarm() {
  armed_ = false;
  zeros_ = 0;
  v_ = 0;
  integral_V_ = 0.0;
}

void NativeEsc::filter(const Sensed& sensed) {
  speed_radps_ += 0.5 * (sensed.speed_radps - speed_radps_);
  const double blend = -std::expm1(-kPeriod_s / params_.current_filter_s);
  current_A_ += blend * (sensed.bus_current_A - current_A_);
  bus_voltage_V_ = sensed.bus_voltage_V;
}

void NativeEsc::protect(std::int64_t t_ns, const Sensed& sensed) {
  const bool at_rest = speed_radps_ < kTurning_radps;
  low_voltage_ =
      bus_voltage_V_ < (at_rest && !armed_ ? params_.arming_voltage_V : params_.low_voltage_V);
  if (armed_ && t_ns - last_valid_ns_ >= params_.watchdog_ns) disarm();
  if (sensed.winding_peak_A > params_.trip_current_A) trouble_ = Trouble::over_current;
  if (armed_ && v_ > 0 && sensed.blocked) trouble_ = Trouble::desync;
  if (trouble_ != Trouble::none && armed_) disarm();
}

NativeEsc::Drive NativeEsc::step(std::int64_t t_ns, const Sensed& sensed) {
  filter(sensed);
  protect(t_ns, sensed);
  return drive(sensed);
}

NativeEsc::Drive NativeEsc::drive(const Sensed& sensed) {
  saturated_ = false;
  if (!armed_ || v_ == 0 || bus_voltage_V_ <= 0.0) {
    integral_V_ = 0.0;
    wanted_speed_radps_ = 0.0;
    return {};
  }
  const double voltage = limited(control_voltage(sensed), sensed);
  return {.duty = voltage / bus_voltage_V_, .braking = params_.mode != io::EscMode::duty};
}

double NativeEsc::speed_for_thrust(double thrust_N) const {
  const double a = params_.thrust_square_Nprpm2, b = params_.thrust_linear_Nprpm;
  return (-b + std::sqrt(b * b + 4.0 * a * thrust_N)) / (2.0 * a) / kRpm_per_radps;
}

double NativeEsc::control_voltage(const Sensed& sensed) {
  const double value = io::value_of_setpoint(params_.mode, v_);
  if (params_.mode == io::EscMode::duty) return value / 100.0 * bus_voltage_V_;

  const double wd =
      params_.mode == io::EscMode::rpm ? value / kRpm_per_radps : speed_for_thrust(value);
  wanted_speed_radps_ = wd;
  const double kt = params_.back_emf_Vspradps;
  const double i_d = params_.no_load_current_A + params_.torque_Nmps2prad2 * wd * wd / kt;
  const double error = wd - speed_radps_;
  const double voltage = kt * wd + ohm(wd) * i_d + params_.kp_Vspradps * error;
  // Anti-windup: the integral moves only while what it asks for is given, or back from the limit.
  const double next = integral_V_ + params_.ki_Vprad * error * kPeriod_s;
  const double asked = voltage + next;
  const double given = limited(asked, sensed);
  if (asked == given || (asked > given) == (error < 0.0)) integral_V_ = next;
  return voltage + integral_V_;
}

double NativeEsc::limited(double voltage, const Sensed& sensed) {
  const double emf = params_.back_emf_Vspradps * sensed.speed_radps;
  const double low = std::max(0.0, emf - params_.brake_current_A * params_.resistance_ohm);
  const double high =
      std::min(bus_voltage_V_, emf + params_.max_current_A * ohm(sensed.speed_radps));
  const double given = std::clamp(voltage, std::min(low, high), high);
  saturated_ = given != voltage;
  return given;
}

io::EscStatus NativeEsc::status() const {
  using Flag = io::EscFlag;
  io::EscStatus status{current_A_, speed_radps_ * kRpm_per_radps, 0};
  const auto raise = [&status](bool on, std::uint8_t flag) {
    if (on) status.flags |= flag;
  };
  raise(armed_, Flag::kArmed);
  raise(speed_radps_ >= kTurning_radps, Flag::kTurning);
  raise(saturated_, Flag::kSaturated);
  raise(trouble_ == Trouble::over_current, Flag::kOverCurrent);
  raise(low_voltage_, Flag::kUnderVoltage);
  raise(trouble_ == Trouble::desync || trouble_ == Trouble::cut, Flag::kDesync);
  return status;
}

}  // namespace whirl::flight
