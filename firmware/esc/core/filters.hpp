// Filters of what the thrust estimator is fed with: a first-order one for bus current and duty, and the
// model-based complementary filter of rotor speed after Fig 5.2: the motor's own equation predicts, a
// PI on the innovation pulls towards what was measured, and the derivative comes out clean.
//
//   Rate    one update per control period
//   Why no model for the current (Fig 5.4): the windings' L/R of 0.2 ms lies far below the control
//           period, so the model would only repeat the voltage equation, which does not hold where the
//           current has gaps (falls, little duty)
//   Source  [Bangura 2017, sec. 5.2.1, eq. 5.3]
#pragma once
#include "firmware/esc/core/calibration.hpp"

namespace fw::esc {

struct Innovation {
  float kp;  // 1/s
  float ki;  // 1/s^2
};

class LowPass {
 public:
  LowPass(float time_constant_s, float period_s)
      : blend_(period_s / (time_constant_s + period_s)) {}
  float update(float x) { return value_ += blend_ * (x - value_); }
  float value() const { return value_; }
  void restart(float x) { value_ = x; }

 private:
  float blend_;
  float value_ = 0.0f;
};

class SpeedFilter {
 public:
  SpeedFilter(const MotorConstants& motor, const StaticMap& free_air, float period_s,
              Innovation gains)
      : free_air_(free_air),
        per_inertia_(1.0f / motor.inertia_kgm2),
        period_s_(period_s),
        gains_(gains) {}
  // torque_Nm: of the motor on the shaft, losses taken off; speed: measured.
  void update(float torque_Nm, float speed_radps);
  float speed_radps() const { return speed_radps_; }
  float acceleration_radps2() const { return acceleration_radps2_; }
  void restart(float speed_radps);

 private:
  StaticMap free_air_;
  float per_inertia_, period_s_;
  Innovation gains_;
  float speed_radps_ = 0.0f;
  float acceleration_radps2_ = 0.0f;
  float offset_radps2_ = 0.0f;  // integral: aerodynamic torque other than in free air
};

}  // namespace fw::esc
