// What the firmware believes about its vehicle. Its own numbers: never shared with a simulation.
//
//   Frame   B: forward-right-down at the centre of mass; rotors 1..4 at +x, +y, -x, -y
//   Source  HP quad [Bangura 2017, Fig. 3.1c, tables 3.3 to 3.6]; inertia from its parts list;
//           gains by the loop analysis in each comment, checked in tests/closed_loop_test.cpp
#pragma once
#include "firmware/esc/core/setpoint.hpp"

namespace fw::config {

inline constexpr float kGravity_mps2 = 9.80665f;

inline constexpr float kMass_kg = 0.900f;
inline constexpr float kInertia_kgm2[3] = {0.0125f, 0.0125f, 0.0235f};
inline constexpr float kArm_m = 0.25f;
inline constexpr float kRotorHeight_m = 0.03f;  // above the centre of mass
// How a sensor is soldered: along each of B's axes, which of its own counts and with what sign.
struct Mounting {
  unsigned axis[3];
  float sign[3];
};
inline constexpr Mounting kImuMounting{{0, 1, 2}, {1.0f, -1.0f, -1.0f}};  // x forward, y left, z up
inline constexpr Mounting kMagMounting{{1, 0, 2},
                                       {-1.0f, 1.0f, 1.0f}};  // x right, y backwards, z down
// From a receiver's measurement to its first byte: the 110 ms to the end of a solution that autopilots reckon
// with for this generation, less 140 bytes at 57600 baud.
inline constexpr float kGpsLatency_s = 0.086f;
// Torque over thrust at hover: shaft power of a figure of merit of 0.69 at 2.21 N, 3950 RPM.
inline constexpr float kTorquePerThrust_m = 0.0165f;

// Rotor drag, force = -c T v sideways, until flights have identified it [Bangura 2017, 4.4.7].
inline constexpr float kDrag_spm = 0.04f;

// The frame's drag by the square of speed, over thrust in hover. An estimate from the parts' sizes, measured
// by nobody: two arms of 20 cm by 15 mm, three motors of 28 by 36 mm, the battery's 33 by 35 mm, boards of
// 50 by 40 mm, two legs of 10 cm by 8 mm; a coefficient of 1.1 for bars and plates, air of 1.2 kg/m^3.
// A third more or less of it is 6 cm/s of wind in 3 m/s.
inline constexpr float kSilhouette_m2 = 2 * 0.200f * 0.015f + 3 * 0.028f * 0.036f +
                                        0.033f * 0.035f + 0.050f * 0.040f + 2 * 0.100f * 0.008f;
inline constexpr float kFrameDrag_s2pm2 =
    0.5f * 1.2f * 1.1f * kSilhouette_m2 / (kMass_kg * kGravity_mps2);

// The mode that the ESCs are set to: v = 1..2047 spans its range, v = 0 stops the motor. What two images of
// different modes share is compiled without (firmware/images.cmake).
#ifndef FW_ESC_MODE  // the image flight_st is built with thrust_by_power
#define FW_ESC_MODE thrust_by_speed
#endif
#ifndef FW_ANY_ESC_MODE
inline constexpr float kThrustMin_N = esc::range_of(esc::Mode::FW_ESC_MODE).min;
inline constexpr float kThrustMax_N = esc::range_of(esc::Mode::FW_ESC_MODE).max;
#endif
inline constexpr float kThrustUsable_N = 6.0f;  // per rotor, with the battery sagging

// Attitude: torque = -Kw (rate + Kq angle). Crossover 18 rad/s: half a set-point period (10 ms), the
// rotors within their rates (4 ms, rotor_response.hpp), the IMU's filter (2 ms) and the averaging (3 ms)
// leave some 43 degrees there; were they a lag of 25 ms, 24 degrees.
inline constexpr float kRateGain_Nms[3] = {0.200f, 0.200f, 0.080f};
inline constexpr float kAngleOverRate_radps[3] = {9.0f, 9.0f, 1.5f};
// Angle trim: what the rotors' and the centre of mass's scatter needs in the mean.
inline constexpr float kAngleIntegral_Nmps[3] = {0.6f, 0.6f, 0.03f};
inline constexpr float kAngleIntegralLimit_Nm[3] = {0.15f, 0.15f, 0.03f};

// Position: acceleration = -Kp error - Kd velocity error - Ki integral; 40 Hz.
inline constexpr float kPositionGain_ps2[3] = {3.0f, 3.0f, 6.0f};
inline constexpr float kVelocityGain_ps[3] = {2.8f, 2.8f, 4.5f};
inline constexpr float kPositionIntegral_ps3[3] = {0.6f, 0.6f, 3.0f};
inline constexpr float kIntegralLimit_mps2[3] = {1.5f, 1.5f, 3.0f};
inline constexpr float kTiltLimit_tan = 0.40f;  // 22 degrees

// Reference: speed and acceleration that a set-point may ask for.
inline constexpr float kReferenceGain_ps = 1.5f;  // critically damped with four times this inside
inline constexpr float kSpeedLimit_mps = 1.2f, kClimbLimit_mps = 0.5f;
inline constexpr float kCruiseAccelerationLimit_mps2 = 1.2f;  // of a commanded velocity
inline constexpr float kAccelerationLimit_mps2 = 1.5f, kClimbAccelerationLimit_mps2 = 0.8f;

inline constexpr float kDescent_mps = 0.35f, kTouchdown_mps = 0.25f, kTouchdownHeight_m = 0.35f;

}  // namespace fw::config
