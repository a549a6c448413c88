// What the motors' currents add to the magnetometer: a field per ampere of each, from a run of one after
// the other on the ground ("compassmot").
//
//   Model    m = m0 + sum_i k_i I_i: I_i as motor i's ESC tells it, k_i a field in B. The pack's leads carry the
//            sum of all, so theirs is in each k_i
//   Turned   the rotors' torque makes a vehicle creep round on its legs, by degrees: the field that does is taken
//            off by the gyro, whose rates are summed up (0.1 mrad/s of drift: 0.1 uT at the end)
//   Method   all idle, then each motor in turn pulls kThrust_N while the others idle, 3 s each; least squares
//            over what the field says after the first second. m0 and the 4 k_i of an axis are 5 unknowns
//   Thrust   2 N is less than a quarter of the weight: no leg lifts (that takes 2.9 N at the end of an arm, with
//            legs at half of it)
//   Refused  a field that moves otherwise than with the currents (0.8 uT RMS), a current that did not change by
//            0.3 A, a vehicle that turned by more than 15 degrees
//   Error    a mean of 150 samples of 0.2 uT over 1 A: 0.02 uT/A. tests/calibration_test.cpp, and
//            test_plans/flight/magnetometer_currents.lua
#pragma once
#include <array>

#include "firmware/calibration/least_squares.hpp"
#include "firmware/math.hpp"

namespace fw {

using MotorCurrents = std::array<float, 4>;  // A

class MotorFieldCalibration {
 public:
  static constexpr float kThrust_N = 2.0f;

  void start();
  void step(const Vector3& w_B_radps, float dt_s) {
    t_s_ += dt_s;
    turned_ = turned(turned_, w_B_radps, dt_s);
  }
  void add(const Vector3& m_B_uT, const MotorCurrents& current_A);
  int motor() const;  // that pulls now: 0..3, or -1
  float share_done() const { return t_s_ / (kPhases * kPhase_s); }
  bool done() const { return t_s_ >= kPhases * kPhase_s; }
  bool solve(std::array<Vector3, 4>& k_B_uTpA) const;

 private:
  static constexpr int kPhases = 9;  // idle, 1, idle, 2, ..
  static constexpr float kPhase_s = 3.0f, kSettle_s = 1.0f;

  int phase() const { return static_cast<int>(t_s_ / kPhase_s); }

  float t_s_ = 0.0f;
  Vector3 first_uT_ = Vector3::Zero();
  Quaternion turned_ = Quaternion::Identity();  // since the first sample
  MotorCurrents least_A_{}, most_A_{};
  LeastSquares sums_;
};

}  // namespace fw
