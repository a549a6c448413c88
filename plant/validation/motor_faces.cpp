#include "plant/validation/motor_faces.hpp"

#include <algorithm>

#include "plant/motor/switched_motor.hpp"

namespace whirl::plant {
namespace {

constexpr double kSubStep_s = 1.25e-4;

MotorFace face(const MotorBooks& books, double time_s, double speed_radps) {
  const double shaft_J = books.air_J + books.no_load_J + books.kinetic_J;
  return {speed_radps, shaft_J / time_s / speed_radps, books.winding_charge_C / time_s,
          books.bus_charge_C / time_s};
}

MotorBooks run_period(SwitchedMotor& motor, double period_s, double duty, bool diode) {
  MotorBooks sum;
  const double on_s = duty * period_s;
  for (double t = 0.0; t < period_s - 1e-12;) {
    const bool on = t < on_s - 1e-12;
    const double h = std::min(period_s / 25.0, (on ? on_s : period_s) - t);
    motor.set_bridge(six_step(sector_of(motor.electrical_angle_rad()), on, !diode));
    sum += motor.run(h);
    t += h;
  }
  return sum;
}

}  // namespace

MotorFace averaged_face(const FaceCase& c, double duty, bool diode) {
  AveragedMotor motor(c.motor);
  motor.set_speed(0.8 * duty * c.bus_V / c.motor.torque_constant_NmpA);
  MotorBooks sum;
  constexpr int kSettle = 14000, kMeasure = 2000;
  for (int k = 0; k < kSettle + kMeasure; ++k) {
    if (k == kSettle) sum = {};
    sum += motor.step({c.bus_V, duty, diode}, {c.quadratic_Nm_s2, 0.0}, kSubStep_s);
  }
  return face(sum, kMeasure * kSubStep_s, motor.speed_radps());
}

MotorFace switched_face(const FaceCase& c, double duty, bool diode, double start_radps) {
  const double period_s = 1.0 / c.motor.pwm_Hz;
  constexpr int kSettle = 6000, kMeasure = 3000;
  SwitchedMotor motor(c.motor);
  motor.set_bus(c.bus_V);
  motor.set_load({c.quadratic_Nm_s2, 0.0});
  motor.set_speed(start_radps);
  for (int k = 0; k < kSettle; ++k) run_period(motor, period_s, duty, diode);
  MotorBooks sum;
  double speed = 0.0;
  for (int k = 0; k < kMeasure; ++k) {
    sum += run_period(motor, period_s, duty, diode);
    speed += motor.speed_radps() / kMeasure;
  }
  return face(sum, kMeasure * period_s, speed);
}

}  // namespace whirl::plant
