#include "plant/power_bus.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.hpp"
#include "plant/base/motor_count.hpp"

namespace whirl::plant {
namespace {

constexpr double kAgree_V = 1e-8;
constexpr int kMostRounds = 30;

}  // namespace

BusDraw step_bus(std::span<AveragedMotor> motors, std::span<Drive> drives,
                 std::span<const ShaftLoad> loads, double avionics_A, Battery& battery, double dt_s,
                 std::span<MotorBooks> books) {
  WHIRL_CHECK(motors.size() <= kMostMotors, motors.size());
  std::array<AveragedMotor::Trial, kMostMotors> trials;
  const double source = battery.source_V(), ohm = battery.series_resistance_ohm();
  // The last sub-step's voltage is close: one correction is usually enough.
  const double before = drives.empty() ? 0.0 : drives[0].bus_V;
  BusDraw draw{.bus_V = before > 0.0 ? before : source};
  double slope = 1.0;  // of the miss over the voltage, nearly constant; then the secant's
  for (std::size_t i = 0; i < motors.size(); ++i) {
    drives[i].bus_V = draw.bus_V;
    motors[i].prepare(drives[i], dt_s);
    slope += ohm / dt_s * motors[i].bus_charge_per_volt(drives[i], dt_s);
  }
  double last_V = 0.0, last_miss_V = 0.0;
  for (int round = 0; round < kMostRounds; ++round) {
    draw.charge_C = avionics_A * dt_s;
    for (std::size_t i = 0; i < motors.size(); ++i) {
      drives[i].bus_V = draw.bus_V;
      trials[i] = motors[i].attempt(drives[i], loads[i], dt_s);
      draw.charge_C += trials[i].books.bus_charge_C;
    }
    draw.residual_V = std::max(0.0, source - ohm * draw.charge_C / dt_s) - draw.bus_V;
    if (std::abs(draw.residual_V) < kAgree_V || round + 1 == kMostRounds) break;
    if (round > 0 && draw.bus_V != last_V) {
      const double secant = (last_miss_V - draw.residual_V) / (draw.bus_V - last_V);
      if (secant > 0.3) slope = secant;  // a kink between the two says nothing
    }
    last_V = draw.bus_V, last_miss_V = draw.residual_V;
    draw.bus_V = std::max(0.0, draw.bus_V + draw.residual_V / slope);
  }
  for (std::size_t i = 0; i < motors.size(); ++i) {
    motors[i].accept(trials[i]);
    books[i] = trials[i].books;
  }
  draw.battery = battery.draw(draw.charge_C, dt_s);
  return draw;
}

}  // namespace whirl::plant
