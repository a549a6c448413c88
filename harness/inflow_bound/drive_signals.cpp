#include "harness/inflow_bound/drive_signals.hpp"

#include <algorithm>
#include <cmath>

#include "plant/motor/averaged_motor.hpp"

namespace whirl::inflow_bound {
namespace {

// Kt of sintered magnets per kelvin: -0.1 % [Bangura2017 gives none; NdFeB, remanence -0.09 to -0.12 %/K].
constexpr double kMagnet_pK = -0.001;
constexpr double kStep_s = 2e-4;
constexpr int kSettle = 15;  // 3 ms: fifteen time constants and more of such a winding

struct Held {
  double torque_Nm = 0.0;  // left for the air
  Signals signals = Signals::Zero();
};

// The shaft keeps its speed: a flywheel of 1 kg m2 gains 1e-5 of it in this time.
Held at_duty(const plant::MotorParams& motor, double speed_radps, double bus_V, double duty) {
  plant::MotorParams held = motor;
  held.inertia_kgm2 = 1.0;
  plant::AveragedMotor winding(held);
  winding.set_speed(speed_radps);
  const plant::Drive drive{.bus_V = bus_V, .duty = duty, .diode = true};
  for (int i = 0; i < kSettle; ++i) winding.step(drive, {}, kStep_s);
  const plant::MotorBooks books = winding.step(drive, {}, kStep_s);
  return {books.kinetic_J / (kStep_s * speed_radps), {books.bus_charge_C / kStep_s, bus_V * duty}};
}

template <typename Change>
Signals slope(const plant::MotorParams& motor, const Shaft& shaft, double bus_V, double sigma,
              const Signals& at, const Change& change) {
  if (sigma == 0.0) return Signals::Zero();
  plant::MotorParams moved = motor;
  Shaft load = shaft;
  change(moved, load);
  return signals_of(moved, load, bus_V) - at;
}

double squared(double x) {
  return x * x;
}

}  // namespace

// Torque over duty is nearly a line, with a kink where the current begins to have gaps.
Signals signals_of(const plant::MotorParams& motor, const Shaft& shaft, double bus_V) {
  const auto at = [&](double duty) { return at_duty(motor, shaft.speed_radps, bus_V, duty); };
  double low = 0.0, high = 1.0;
  Held below = at(low), above = at(high);
  if (above.torque_Nm <= shaft.torque_Nm) return above.signals;
  for (int i = 0; i < 60 && high - low > 1e-9; ++i) {
    const double lack = (shaft.torque_Nm - below.torque_Nm) / (above.torque_Nm - below.torque_Nm);
    const double share = i % 3 == 2 ? 0.5 : std::clamp(lack, 0.001, 0.999);
    const double duty = low + share * (high - low);
    const Held held = at(duty);
    const double off_Nm = held.torque_Nm - shaft.torque_Nm;
    if (std::abs(off_Nm) <= 1e-9) return held.signals;
    if (off_Nm < 0.0) {
      low = duty, below = held;
    } else {
      high = duty, above = held;
    }
  }
  return 0.5 * (below.signals + above.signals);
}

double current_sigma_A(const plant::CurrentShuntParams& s, const Doubts& d, double bus_A) {
  const double wander2 = 2.0 * squared(s.wander_A) * -std::expm1(-d.since_zero_s / s.wander_time_s);
  const double warm = s.warm_up_A * std::exp(-d.powered_s / s.warm_up_time_s) *
                      -std::expm1(-d.since_zero_s / s.warm_up_time_s);
  const double noise2 =
      squared(s.noise_A) / std::max(1.0, d.zero_taken_s * d.sample_rate_Hz) +
      squared(s.noise_A + s.noise_per_A * bus_A) / std::max(1.0, d.averaged_s * d.sample_rate_Hz);
  return std::sqrt(wander2 + squared(warm) + noise2);
}

Eigen::Matrix2d covariance(const plant::MotorParams& motor, const plant::CurrentShuntParams& sense,
                           const Doubts& d, const Shaft& shaft, double bus_V) {
  const Signals at = signals_of(motor, shaft, bus_V);
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  sum(0, 0) = squared(current_sigma_A(sense, d, at.x())) + squared(d.gain * at.x());
  sum(1, 1) = squared(d.step_V);
  const auto add = [&](double sigma, const auto& change) {
    const Signals moved = slope(motor, shaft, bus_V, sigma, at, change);
    sum += moved * moved.transpose();
  };
  add(d.winding_K, [&](plant::MotorParams& m, Shaft&) {
    m.resistance_ohm += m.winding_resistance_ohm * m.copper_temp_coefficient_pK * d.winding_K;
  });
  add(d.magnet_K, [&](plant::MotorParams& m, Shaft&) {
    m.torque_constant_NmpA *= 1.0 + kMagnet_pK * d.magnet_K;
  });
  add(d.friction, [&](plant::MotorParams& m, Shaft&) { m.no_load_current_A *= 1.0 + d.friction; });
  add(d.density, [&](plant::MotorParams&, Shaft& load) { load.torque_Nm *= 1.0 + d.density; });
  return sum;
}

}  // namespace whirl::inflow_bound
