// The input of a three-axis accelerometer and gyroscope at their place, before range and counts.
//
//   Frame   in: motion of B's origin; out: sensor axes, nominally parallel to B (a part that is
//           soldered turned is its device's matter)
//   Units   SI
//   Method  specific force at the lever arm: f + alpha x r + w x (w x r); then scale, misalignment,
//           turn-on bias, bias instability, white noise, vibration at rotor and blade frequencies
//   Unbalance  of a rotor, mass x arm, shakes the body by m r w^2 / M in the disc's plane, turning with the
//           rotor. With it come its second harmonic in the plane and the blades' passing along the shaft,
//           as shares of that amplitude: no theory gives them, they are what is set
//   Valid   sampled at a steady pace of 50 Hz to 10 kHz; the noise is the mean since the last sample
//   Error   lever arm in closed form, Allan deviations within 10 % (tests/imu_test.cpp)
//   Left out range and quantisation (device), temperature, g-sensitivity of the gyro, the turning that an
//           unbalance far from the centre of mass adds (the gyroscope's own figure stands for it), the
//           frame's resonances; the sense of turning
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "base/result.hpp"
#include "plant/base/motor_count.hpp"

namespace whirl::plant {

struct TriadParams {
  double noise_density = 0.0;         // unit / sqrt(Hz): Allan deviation at 1 s
  double bias_instability = 0.0;      // unit: Allan floor / 0.664
  double turn_on_bias = 0.0;          // unit, standard deviation per axis
  double scale_error = 0.0;           // standard deviation per axis, 1 = 100 %
  double cross_axis = 0.0;            // of one axis in each other, standard deviation
  double vibration_per_radps2 = 0.0;  // unit / (rad/s)^2: amplitude by rotor speed squared
};

struct ImuParams {
  TriadParams accelerometer;      // m/s^2
  TriadParams gyroscope;          // rad/s
  double unbalance_second = 0.2;  // at 2/rev, share of the 1/rev amplitude
  double unbalance_blades = 0.3;  // at blade_count/rev, along the shaft
  int blade_count = 2;
  Eigen::Vector3d p_BS_B_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d misalignment_rad = Eigen::Vector3d::Zero();  // small turn of S against B
};

ImuParams mpu6000_physics();  // datasheet densities, typical biases
Result<Done> validate(const ImuParams& params, const std::string& place);

struct ImuMotion {
  Eigen::Vector3d specific_force_B_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_WB_B_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d alpha_WB_B_radps2 = Eigen::Vector3d::Zero();
  std::array<double, kMostMotors> rotor_speed_radps{};  // of rotors that are not there: 0
  std::array<double, kMostMotors> unbalance_m{};        // mass x arm over the vehicle's mass
};

struct ImuSample {
  Eigen::Vector3d specific_force_S_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_S_radps = Eigen::Vector3d::Zero();
};

class Imu {
 public:
  // `name` tells the streams of two sensors of one kind apart.
  Imu(const ImuParams& params, std::uint64_t seed, const std::string& name = "imu");
  ~Imu();
  Imu(Imu&&) noexcept;
  Imu& operator=(Imu&&) noexcept;

  // Pre: t_s rises from call to call.
  ImuSample sample(double t_s, const ImuMotion& motion);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace whirl::plant
