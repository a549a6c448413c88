// The two faces of the motor model in steady state under one propeller load: each was written without
// the other, each is the other's oracle (the proof of `whirl validate`, tests/faces_test.cpp).
#pragma once
#include "plant/motor/averaged_motor.hpp"
#include "plant/motor/motor_params.hpp"

namespace whirl::plant {

struct MotorFace {
  double speed_radps, shaft_Nm, winding_A, bus_A;
};

// The air takes `quadratic_Nm_s2` times the speed squared.
struct FaceCase {
  MotorParams motor;
  double bus_V = 0.0, quadratic_Nm_s2 = 0.0;
};

MotorFace averaged_face(const FaceCase& c, double duty, bool diode);
// The bridge-driven face under PWM, commutated at the right angle, in 25 slices per PWM period.
MotorFace switched_face(const FaceCase& c, double duty, bool diode, double start_radps);

}  // namespace whirl::plant
