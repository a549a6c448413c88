// Model-based complementary filters for winding current and rotor speed, after Fig 5.4 and Fig 5.2:
// the motor's own equations predict, a PI on the innovation pulls towards what was measured.
//
//   Rate    one update per control period; the electrical pole (0.6 ms) is stepped exactly, so that
//           a period longer than it is no danger
//   Source  [Bangura 2017, sec. 5.2.1, eq. 5.3]
#pragma once
#include "firmware/esc/core/calibration.hpp"

namespace fw::esc {

struct Innovation {
  float kp;  // 1/s
  float ki;  // 1/s^2
};

class CurrentFilter {
 public:
  CurrentFilter(const MotorConstants& motor, float period_s, Innovation gains);
  // voltage_V: applied to the winding over the last period; speed and current: measured.
  float update(float voltage_V, float speed_radps, float current_A);
  float current_A() const { return current_A_; }
  void restart(float current_A);

 private:
  MotorConstants motor_;
  float period_s_;
  float blend_;  // 1 - exp(-period R / L)
  Innovation gains_;
  float current_A_ = 0.0f;
  float offset_V_ = 0.0f;  // integral: what the model's voltage balance is off by
};

class SpeedFilter {
 public:
  SpeedFilter(const MotorConstants& motor, const StaticMap& free_air, float period_s,
              Innovation gains)
      : motor_(motor), free_air_(free_air), period_s_(period_s), gains_(gains) {}
  void update(float current_A, float speed_radps);
  float speed_radps() const { return speed_radps_; }
  float acceleration_radps2() const { return acceleration_radps2_; }
  void restart(float speed_radps);

 private:
  MotorConstants motor_;
  StaticMap free_air_;
  float period_s_;
  Innovation gains_;
  float speed_radps_ = 0.0f;
  float acceleration_radps2_ = 0.0f;
  float offset_radps2_ = 0.0f;  // integral: aerodynamic torque other than in free air
};

}  // namespace fw::esc
