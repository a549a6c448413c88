#include "plant/averaged_powertrain.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/check.hpp"
#include "plant/power_bus.hpp"

namespace whirl::plant {
namespace {

constexpr double kSubStep_s = 1.25e-4;  // electrical time constant 0.63 ms

EnergyBooks sum_of(const std::vector<MotorBooks>& motors, const BatteryBooks& pack) {
  MotorBooks all;
  for (const MotorBooks& m : motors) all += m;
  return {.chemical_J = pack.chemical_J,
          .battery_J = pack.series_J + pack.relaxation_J + pack.dip_J,
          .copper_J = all.copper_J,
          .diode_J = all.diode_J,
          .no_load_J = all.no_load_J,
          .magnetic_J = all.magnetic_J,
          .kinetic_J = all.kinetic_J,
          .air_J = all.air_J};
}

}  // namespace

AveragedPowertrain::AveragedPowertrain(const std::vector<MotorParams>& motors,
                                       const BatteryParams& battery, double avionics_current_A)
    : battery_(battery),
      avionics_current_A_(avionics_current_A),
      motors_(motors.begin(), motors.end()),
      shorts_A_(motors.size(), 0.0),
      drives_(motors.size(), Drive{.diode = true}),
      loads_(motors.size()),
      books_(motors.size()),
      total_(motors.size()) {}

void AveragedPowertrain::command(std::size_t motor, const MotorCommand& command) {
  drives_.at(motor).duty = std::clamp(command.duty, 0.0, 1.0);
  drives_[motor].diode = command.freewheel == Freewheel::diode;
  shorts_A_[motor] = drives_[motor].duty > 0.0 ? command.short_A : 0.0;
}

void AveragedPowertrain::set_loads(std::span<const ShaftLoad> loads) {
  WHIRL_CHECK(loads.size() == loads_.size(), loads.size(), loads_.size());
  std::copy(loads.begin(), loads.end(), loads_.begin());
}

void AveragedPowertrain::step(double dt_s, PowertrainState& state) {
  WHIRL_CHECK(state.motors.size() == count(), state.motors.size(), count());
  std::fill(total_.begin(), total_.end(), MotorBooks{});
  for (std::size_t i = 0; i < count(); ++i) {
    state.motors[i].winding_peak_A = std::abs(motors_[i].current_A());
  }
  const int steps = std::max(1, static_cast<int>(std::ceil(dt_s / kSubStep_s - 1e-9)));
  const double short_A = std::accumulate(shorts_A_.begin(), shorts_A_.end(), 0.0);
  double charge = 0.0, voltage = 0.0, avionics_J = 0.0, short_J = 0.0;
  BatteryBooks pack;
  for (int k = 0; k < steps; ++k) {
    const BusDraw draw = step_bus(motors_, drives_, loads_, avionics_current_A_ + short_A, battery_,
                                  dt_s / steps, books_);
    charge += draw.charge_C;
    voltage += draw.bus_V / steps;
    avionics_J += draw.bus_V * avionics_current_A_ * dt_s / steps;
    short_J += draw.bus_V * short_A * dt_s / steps;
    pack += draw.battery;
    for (std::size_t i = 0; i < count(); ++i) {
      total_[i] += books_[i];
      state.motors[i].winding_peak_A =
          std::max(state.motors[i].winding_peak_A, std::abs(motors_[i].current_A()));
    }
  }
  for (std::size_t i = 0; i < count(); ++i) {
    motors_[i].warm(total_[i], dt_s);
    MotorState& m = state.motors[i];
    m.speed_radps = motors_[i].speed_radps();
    m.bus_current_A = total_[i].bus_charge_C / dt_s + shorts_A_[i];
    m.winding_temperature_K = motors_[i].winding_temperature_K();
    m.blocked = motors_[i].blocked();
  }
  state.bus_voltage_V = voltage;
  state.battery_current_A = charge / dt_s;
  state.charge_used_C = battery_.charge_used_C();
  state.energy = sum_of(total_, pack);
  state.energy.avionics_J = avionics_J;
  state.energy.short_J = short_J;
}

}  // namespace whirl::plant
