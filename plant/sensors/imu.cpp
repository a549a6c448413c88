#include "plant/sensors/imu.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "base/check.hpp"
#include "plant/base/bounds.hpp"
#include "plant/sensors/noise.hpp"

namespace whirl::plant {
namespace {

using Eigen::Vector3d;

constexpr double kFirstInterval_s = 1e-3;
constexpr double kTwoPi = 6.283185307179586;

struct Triad {
  Triad(const TriadParams& params, std::uint64_t seed, const std::string& name) : p(params) {
    for (int i = 0; i < 3; ++i) {
      const std::string axis = name + "." + "xyz"[i];
      white.emplace_back(params.noise_density, seed, axis + ".white");
      drift.emplace_back(params.bias_instability, seed, axis + ".drift");
      turn_on[i] = draw_normal(params.turn_on_bias, seed, axis + ".turn_on");
      scale[i] = 1.0 + draw_normal(params.scale_error, seed, axis + ".scale");
      for (int of = 0; of < 3; ++of) {
        if (of == i) continue;
        cross(i, of) = draw_normal(params.cross_axis, seed, axis + ".cross." + "xyz"[of]);
      }
    }
  }
  Vector3d read(const Vector3d& truth, const Vector3d& shake, double dt_s) {
    Vector3d out = scale.cwiseProduct(truth) + turn_on + p.vibration_per_radps2 * shake;
    if (p.cross_axis > 0.0) out += cross * truth;
    for (int i = 0; i < 3; ++i) out[i] += white[i].sample(dt_s) + drift[i].step(dt_s);
    return out;
  }
  TriadParams p;
  std::vector<WhiteNoise> white;
  std::vector<Flicker> drift;
  Vector3d turn_on, scale;
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
};

void check(Bounds& b, const TriadParams& p) {
  b.within("noise_density", p.noise_density, 0.0, 10.0);
  b.within("bias_instability", p.bias_instability, 0.0, 10.0);
  b.within("turn_on_bias", p.turn_on_bias, 0.0, 20.0);
  b.within("scale_error", p.scale_error, 0.0, 0.5);
  b.within("cross_axis", p.cross_axis, 0.0, 0.5);
  b.within("vibration_per_radps2", p.vibration_per_radps2, 0.0, 1.0);
}

}  // namespace

// [MPU6000] rev 3.4, tables 6.1 and 6.2: 0.005 deg/s and 400 ug per root Hz. Biases as after the
// usual factory trim; instability typical of the class.
ImuParams mpu6000_physics() {
  ImuParams p;
  p.gyroscope = {.noise_density = 8.73e-5,
                 .bias_instability = 1.0e-4,
                 .turn_on_bias = 0.02,
                 .scale_error = 0.01,
                 .vibration_per_radps2 = 1e-7};
  p.accelerometer = {.noise_density = 3.92e-3,
                     .bias_instability = 1.0e-3,
                     .turn_on_bias = 0.15,
                     .scale_error = 0.01,
                     .vibration_per_radps2 = 3e-6};
  return p;
}

Result<Done> validate(const ImuParams& params, const std::string& place) {
  Bounds b(place);
  check(b, params.accelerometer);
  check(b, params.gyroscope);
  b.within("unbalance_second", params.unbalance_second, 0.0, 10.0);
  b.within("unbalance_blades", params.unbalance_blades, 0.0, 10.0);
  b.within("blade_count", params.blade_count, 1.0, 12.0);
  b.within("distance of the sensor_m", params.p_BS_B_m.norm(), 0.0, 5.0);
  b.within("misalignment_rad", params.misalignment_rad.norm(), 0.0, 0.5);
  return b.result();
}

struct Imu::Parts {
  Parts(const ImuParams& params, std::uint64_t seed, const std::string& name)
      : lever_B_m(params.p_BS_B_m),
        second(params.unbalance_second),
        blades(params.unbalance_blades),
        blade_count(params.blade_count),
        accelerometer(params.accelerometer, seed, name + ".accel"),
        gyroscope(params.gyroscope, seed, name + ".gyro") {
    const double angle = params.misalignment_rad.norm();
    if (angle > 0.0) {
      R_SB =
          Eigen::AngleAxisd(angle, params.misalignment_rad / angle).toRotationMatrix().transpose();
    }
    for (std::size_t i = 0; i < kMostMotors; ++i) {
      phase[i] = draw_uniform(0.0, kTwoPi, seed, name + ".phase" + std::to_string(i));
    }
  }

  // Out-of-balance turns with each rotor in its plane, blade passing shakes along the axis.
  Vector3d shake(const std::array<double, kMostMotors>& speed, double dt_s) {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < kMostMotors; ++i) {
      if (speed[i] == 0.0) continue;
      phase[i] = std::fmod(phase[i] + speed[i] * dt_s, kTwoPi);
      const double strength = speed[i] * speed[i];
      sum += strength * Vector3d(std::cos(phase[i]), std::sin(phase[i]), std::cos(2.0 * phase[i]));
    }
    return sum;
  }

  // At the phases that shake() has brought up to date.
  Vector3d unbalance_mps2(const ImuMotion& m) const {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < kMostMotors; ++i) {
      if (m.unbalance_m[i] == 0.0) continue;
      const double a = m.unbalance_m[i] * m.rotor_speed_radps[i] * m.rotor_speed_radps[i];
      const double once = phase[i], twice = 2.0 * phase[i];
      sum += a * Vector3d(std::cos(once) + second * std::cos(twice),
                          std::sin(once) + second * std::sin(twice),
                          blades * std::cos(blade_count * once));
    }
    return sum;
  }

  Vector3d lever_B_m;
  double second, blades;
  int blade_count;
  Eigen::Matrix3d R_SB = Eigen::Matrix3d::Identity();
  Triad accelerometer, gyroscope;
  std::array<double, kMostMotors> phase{};
  double last_t_s = -kFirstInterval_s;
  bool started = false;
};

Imu::Imu(const ImuParams& params, std::uint64_t seed, const std::string& name)
    : parts_(std::make_unique<Parts>(params, seed, name)) {
  WHIRL_CHECK(validate(params, name).ok());
}
Imu::~Imu() = default;
Imu::Imu(Imu&&) noexcept = default;
Imu& Imu::operator=(Imu&&) noexcept = default;

ImuSample Imu::sample(double t_s, const ImuMotion& m) {
  Parts& p = *parts_;
  const double dt_s = p.started ? t_s - p.last_t_s : kFirstInterval_s;
  WHIRL_CHECK(dt_s > 0.0, t_s, p.last_t_s);
  p.started = true;
  p.last_t_s = t_s;
  const Vector3d& r = p.lever_B_m;
  const Vector3d& w = m.w_WB_B_radps;
  const Vector3d f_B = m.specific_force_B_mps2 + m.alpha_WB_B_radps2.cross(r) + w.cross(w.cross(r));
  const Vector3d shake = p.shake(m.rotor_speed_radps, dt_s);
  return {p.accelerometer.read(p.R_SB * (f_B + p.unbalance_mps2(m)), shake, dt_s),
          p.gyroscope.read(p.R_SB * w, shake, dt_s)};
}

}  // namespace whirl::plant
