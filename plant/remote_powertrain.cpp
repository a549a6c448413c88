#include "plant/remote_powertrain.hpp"

#include <algorithm>
#include <cmath>

#include "base/check.hpp"
#include "plant/motor/averaged_motor.hpp"

namespace whirl::plant {
namespace {

constexpr double kSlow_radps = 20.0;  // below, loads go with the square of speed
// Of a propeller that strikes: from 1000 rad/s in 5 ms, and less than a power stage's steps of 25 us
// could turn back.
constexpr double kStrike_radps2 = 2e5;

}  // namespace

RemotePowertrain::RemotePowertrain(std::size_t motors, const BatteryParams& battery,
                                   double avionics_current_A, double inertia_kgm2)
    : battery_(battery),
      avionics_current_A_(avionics_current_A),
      inertia_kgm2_(inertia_kgm2),
      share_(std::max(1.0, 0.5 * static_cast<double>(motors))),
      shafts_(motors),
      received_(motors),
      torque_Nm_s2_(motors, 0.0),
      brake_Nm_(motors, 0.0),
      dip_V_(motors, 0.0) {
  WHIRL_CHECK(inertia_kgm2 > 0.0, inertia_kgm2);
}

double RemotePowertrain::total_current_A() const {
  double sum = avionics_current_A_;
  for (const RemoteShaftState& shaft : shafts_) sum += shaft.source_current_A;
  return sum;
}

double RemotePowertrain::undipped_V(std::size_t motor) const {
  const double ohm = battery_.series_resistance_ohm();
  return std::max(0.0, battery_.source_V() - ohm * total_current_A() +
                           share_ * ohm * shafts_.at(motor).source_current_A);
}

RemoteShaftLoad RemotePowertrain::load(std::size_t motor) const {
  return {torque_Nm_s2_[motor], brake_Nm_[motor],
          std::max(0.0, undipped_V(motor) - dip_V_.at(motor)),
          share_ * battery_.series_resistance_ohm()};
}

void RemotePowertrain::set_shaft_dip(std::size_t motor, double below_V) {
  WHIRL_CHECK(below_V >= 0.0, motor, below_V);
  dip_V_.at(motor) = below_V;
}

// Those under which the shafts did what has been received.
std::vector<double> RemotePowertrain::take_dips() {
  std::vector<double> latest(count());
  for (std::size_t i = 0; i < count(); ++i) latest[i] = std::min(dip_V_[i], undipped_V(i));
  dips_V_.push_back(std::move(latest));
  while (dips_V_.size() < age_) dips_V_.push_front(std::vector<double>(count(), 0.0));
  std::vector<double> then = std::move(dips_V_.front());
  dips_V_.pop_front();
  return then;
}

void RemotePowertrain::receive(std::size_t motor, const RemoteShaftState& state) {
  const double all = state.speed_radps + state.source_current_A + state.winding_peak_A +
                     state.electrical_in_J + state.copper_J + state.diode_J + state.no_load_J +
                     state.magnetic_J + state.kinetic_J + state.air_J + state.source_J +
                     state.feed_J + state.capacitor_J;
  WHIRL_CHECK(std::isfinite(all), motor);
  WHIRL_CHECK(!received_.at(motor).has_value(), motor);
  received_[motor] = state;
}

void RemotePowertrain::set_speed(std::size_t motor, double speed_radps) {
  WHIRL_CHECK(std::isfinite(speed_radps), motor);
  shafts_.at(motor).speed_radps = speed_radps;
}

void RemotePowertrain::block(std::size_t motor) {
  brake_Nm_.at(motor) = inertia_kgm2_ * kStrike_radps2;
}

void RemotePowertrain::command(std::size_t motor, const MotorCommand& command) {
  WHIRL_CHECK(false, motor, command.duty);  // the bridge is its owner's
}

void RemotePowertrain::set_loads(std::span<const ShaftLoad> loads) {
  WHIRL_CHECK(loads.size() == count(), loads.size(), count());
  for (std::size_t i = 0; i < count(); ++i) {
    WHIRL_CHECK(std::isfinite(loads[i].quadratic_Nm_s2) && std::isfinite(loads[i].constant_Nm), i);
    const double w = std::max(kSlow_radps, std::abs(shafts_[i].speed_radps));
    torque_Nm_s2_[i] = loads[i].quadratic_Nm_s2 + loads[i].constant_Nm / (w * w);
  }
}

void RemotePowertrain::step(double dt_s, PowertrainState& state) {
  WHIRL_CHECK(state.motors.size() == count(), state.motors.size(), count());
  const std::vector<double> dips_V = take_dips();
  for (std::size_t i = 0; i < count(); ++i) {
    WHIRL_CHECK(received_[i].has_value(), i);  // nobody has said what this shaft did
    shafts_[i] = *received_[i];
    received_[i].reset();
  }
  const double total_A = total_current_A();
  state.bus_voltage_V =
      std::max(0.0, battery_.source_V() - battery_.series_resistance_ohm() * total_A);
  const BatteryBooks pack = battery_.draw(total_A * dt_s, dt_s);
  state.battery_current_A = total_A;
  state.charge_used_C = battery_.charge_used_C();
  EnergyBooks& e = state.energy;
  e = {.chemical_J = pack.chemical_J,
       .battery_J = pack.series_J + pack.relaxation_J + pack.dip_J,
       .avionics_J = state.bus_voltage_V * avionics_current_A_ * dt_s};
  const double own_ohm = share_ * battery_.series_resistance_ohm();
  for (std::size_t i = 0; i < count(); ++i) {
    const RemoteShaftState& shaft = shafts_[i];
    const double mean_heat_J = own_ohm * shaft.source_current_A * shaft.source_current_A * dt_s;
    const double lost_J = dips_V[i] * shaft.source_current_A * dt_s;
    e.exchange_J += state.bus_voltage_V * shaft.source_current_A * dt_s -
                    (shaft.source_J + lost_J - mean_heat_J);
    e.battery_J += shaft.feed_J - mean_heat_J + lost_J;
    e.capacitor_J += shaft.capacitor_J;
    e.copper_J += shaft.copper_J;
    e.diode_J += shaft.diode_J;
    e.no_load_J += shaft.no_load_J;
    e.magnetic_J += shaft.magnetic_J;
    e.kinetic_J += shaft.kinetic_J;
    e.air_J += shaft.air_J;
    MotorState& m = state.motors[i];
    m.speed_radps = shaft.speed_radps;
    m.winding_peak_A = shaft.winding_peak_A;
    m.bus_current_A = shaft.source_current_A;
    m.blocked = brake_Nm_[i] > 0.0;
  }
  count_bound(dt_s);
}

double RemotePowertrain::end_J(const Past& past, double dt_s) const {
  double sum_A = 0.0, squares_A2 = 0.0;
  for (const double i_A : past.currents_A) sum_A += i_A, squares_A2 += i_A * i_A;
  return 0.5 * battery_.series_resistance_ohm() * dt_s *
         std::abs(share_ * squares_A2 - sum_A * sum_A);
}

void RemotePowertrain::count_bound(double dt_s) {
  Past now{{}, battery_.source_V()};
  for (const RemoteShaftState& shaft : shafts_) now.currents_A.push_back(shaft.source_current_A);
  while (past_.size() < age_) past_.push_front({std::vector<double>(count(), 0.0), now.source_V});
  const Past& then = past_.front();
  double sum_A = 0.0, squared_jumps_A2 = 0.0;
  for (std::size_t i = 0; i < count(); ++i) {
    const double jump_A = now.currents_A[i] - then.currents_A[i];
    squared_jumps_A2 += jump_A * jump_A;
    sum_A += now.currents_A[i];
  }
  jumps_J_ += 0.5 * share_ * battery_.series_resistance_ohm() * dt_s * squared_jumps_A2;
  source_drift_J_ += std::abs(sum_A * (now.source_V - then.source_V)) * dt_s;
  past_.pop_front();
  past_.push_back(std::move(now));
  ends_J_ = 0.0;
  for (const Past& past : past_) ends_J_ += end_J(past, dt_s);
}

}  // namespace whirl::plant
