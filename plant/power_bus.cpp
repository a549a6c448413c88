#include "plant/power_bus.hpp"

#include <algorithm>
#include <cmath>

namespace whirl::plant {
namespace {

constexpr double kAgree_V = 1e-9;
constexpr int kMostRounds = 30;

double drawn_C(std::span<const AveragedMotor> motors, std::span<Drive> drives,
               std::span<const ShaftLoad> loads, double bus_V, double dt_s) {
  double charge = 0.0;
  for (std::size_t i = 0; i < motors.size(); ++i) {
    drives[i].bus_V = bus_V;
    charge += motors[i].bus_charge_C(drives[i], loads[i], dt_s);
  }
  return charge;
}

}  // namespace

BusDraw step_bus(std::span<AveragedMotor> motors, std::span<Drive> drives,
                 std::span<const ShaftLoad> loads, double avionics_A, Battery& battery, double dt_s,
                 std::span<MotorBooks> books) {
  const double source = battery.source_V(), ohm = battery.series_resistance_ohm();
  // The charge is nearly affine in the voltage: secant steps, started from the open circuit.
  auto miss = [&](double bus_V) {
    const double charge = drawn_C(motors, drives, loads, bus_V, dt_s) + avionics_A * dt_s;
    return std::max(0.0, source - ohm * charge / dt_s) - bus_V;
  };
  for (AveragedMotor& motor : motors) motor.prepare(dt_s);
  double before = source, miss_before = miss(before);
  double bus = std::max(0.0, before + miss_before), miss_now = 0.0;
  for (int round = 0; round < kMostRounds; ++round) {
    miss_now = miss(bus);
    if (std::abs(miss_now) < kAgree_V) break;
    const double slope = (miss_now - miss_before) / (bus - before);
    before = bus;
    miss_before = miss_now;
    bus = std::max(0.0, slope < -0.5 ? bus - miss_now / slope : bus + 0.5 * miss_now);
  }
  BusDraw draw{.bus_V = bus, .charge_C = avionics_A * dt_s, .residual_V = miss_now};
  for (std::size_t i = 0; i < motors.size(); ++i) {
    drives[i].bus_V = bus;
    books[i] = motors[i].step(drives[i], loads[i], dt_s);
    draw.charge_C += books[i].bus_charge_C;
  }
  battery.draw(draw.charge_C, dt_s);
  return draw;
}

}  // namespace whirl::plant
