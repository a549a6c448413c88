// What an ESC can see of the air: current of the bus and mean voltage of the bridge while a propeller turns
// steadily, and how sure it can be of them.
//
//   Units    SI; torque is what the air takes of the shaft
//   Method   the duty at which the plant's averaged motor gives that torque at that speed
//   Sureness covariance of (current, voltage) about what the model says: what the instruments do, and what of
//            motor and air has moved since the ESC was calibrated, each times the signals' slope over it
//   Left out that a slope is one-sided, over one sigma: what of it is curvature is taken for slope
#pragma once
#include <Eigen/Core>

#include "plant/motor/motor_params.hpp"
#include "plant/sensors/current_shunt.hpp"

namespace whirl::inflow_bound {

using Signals = Eigen::Vector2d;  // bus current in A, bridge voltage in V

struct Shaft {
  double speed_radps = 0.0, torque_Nm = 0.0;
};

// Pre: a speed and a torque that the motor reaches on that bus; else the signals at full duty.
Signals signals_of(const plant::MotorParams& motor, const Shaft& shaft, double bus_V);

// One sigma each, of what is not known when a current is judged.
struct Doubts {
  // Since the current sense's zero was found, with the motor at rest and the ESC just started or not.
  double since_zero_s = 3.0;
  double powered_s = 100.0;     // at that zero
  double zero_taken_s = 0.1;    // the zero is a mean over this
  double averaged_s = 1.0;      // and what is judged over this
  double sample_rate_Hz = 1e3;  // independent readings: the amplifier's pole is at 1 kHz
  // Of the voltmeter, where in a step it is: 12 bits of 3.3 V behind 1.5/11.5, over the root of 12.
  double step_V = 1.8e-3;
  // Since it was calibrated.
  double gain = 0.0;  // of the current sense, relative
  double winding_K = 0.0, magnet_K = 0.0;
  double friction = 0.0;  // no-load current, relative
  double density = 0.0;   // of the air, relative
};

// Right after a calibration, cold, the zero just found.
inline Doubts as_calibrated() {
  return {};
}
// Ten minutes into a flight on another day: temperatures within 5 K by a model of them, friction of warm grease
// against cold, air told to 1 % (pressure of the day by 10 hPa, temperature by 2 K).
inline Doubts another_day() {
  return {
      .since_zero_s = 600.0, .winding_K = 5.0, .magnet_K = 5.0, .friction = 0.05, .density = 0.01};
}

// Of the current alone: wander since the zero, what is left of the warm-up, noise of both means.
double current_sigma_A(const plant::CurrentShuntParams& shunt, const Doubts& doubts, double bus_A);

Eigen::Matrix2d covariance(const plant::MotorParams& motor, const plant::CurrentShuntParams& shunt,
                           const Doubts& doubts, const Shaft& shaft, double bus_V);

}  // namespace whirl::inflow_bound
