// A control core in closed loop with a motor without commutation and the model's own rotor in moving air.
#pragma once
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "firmware/esc/core/core.hpp"

namespace fw::esc {

// The rotor of [Bangura 2017, table 5.3] with the c4 that closes its hover: at 490 rad/s and 4.2 m/s
// thrust falls by a sixth and power by a tenth; power rises in an updraft.
inline constexpr ThrustModel kRotor{.c0 = 0.0724f,
                                    .c1 = 6.149e-5f,
                                    .c2 = 0.2993f,
                                    .c3 = 1.2998e-8f,
                                    .c4 = 1.54e-3f,
                                    .d0 = 4.2959f,
                                    .d1 = -1.7154e5f};
inline constexpr float kRadius_m = 0.127f;

inline Calibration calibrated(Mode mode) {
  Calibration c;
  c.mode = mode;
  c.motor.inductance_H = 1e-4f;
  c.motor.overlap_ohm_s = 0.0f;  // the bench has no commutation
  c.losses = {.loss_ohm = 0.16f, .loss_V = 0.0f, .drag_Nm = 0.01005f};
  c.rotor = kRotor;
  c.free_air = {.a2 = at_inflow(kRotor, 0.0f).CT, .a1 = 0.0f, .q2 = at_inflow(kRotor, 0.0f).CP};
  c.identified = true;
  c.sense.warm_up_A = 0.0f;
  c.shared_power = 1.0f;  // this rotor's power rises in an updraft
  return c;
}

class AirBench {
 public:
  explicit AirBench(Mode mode) : core(calibrated(mode)) {}
  explicit AirBench(const Calibration& calibration) : core(calibration) {}

  // Set-points as the bus sends them: one every 20 ms.
  void hold(double value, int ms) {
    const Range range = range_of(core.mode());
    const auto v = static_cast<std::uint16_t>(
        std::lround(1.0 + 2046.0 * (value - range.min) / (range.max - range.min)));
    for (int i = 0; i < ms; ++i) {
      if (i % 20 == 0) core.on_setpoint(value > 0.0 ? v : std::uint16_t{0});
      const Drive drive = core.tick(sensed());
      for (int k = 0; k < 50; ++k) step(drive, 2e-5);
      thrust_log.push_back(thrust_N());
      peak_A = std::max(peak_A, current_A);
    }
  }
  void start(double value) {
    hold(0.0, 600);
    hold(value, 2000);
  }
  double mean_thrust_N(int ms) const {
    double sum = 0.0;
    for (std::size_t i = thrust_log.size() - static_cast<std::size_t>(ms); i < thrust_log.size();
         ++i) {
      sum += thrust_log[i];
    }
    return sum / ms;
  }
  RotorPoint point() const {
    return at_inflow(kRotor, static_cast<float>(down_mps / (std::max(speed, 50.0) * kRadius_m)));
  }
  double thrust_N() const { return point().CT * speed * speed; }
  double power_W() const { return point().CP * speed * speed * speed; }

  Core core;
  double speed = 0.0, current_A = 0.0, peak_A = 0.0, down_mps = 0.0, bus_V = 16.4;
  double shunt_noise_A = 0.0, shunt_offset_A = 0.0;
  std::vector<double> thrust_log;

 private:
  Sensed sensed() {
    return {.bus_voltage_V = static_cast<float>(bus_V),
            .bus_current_A =
                static_cast<float>(bus_A_ + shunt_offset_A + shunt_noise_A * normal_(random_)),
            .speed_radps = static_cast<float>(speed),
            .in_sync = speed > 100.0};
  }
  void step(const Drive& drive, double dt) {
    const double applied_V = drive.duty * bus_V;
    current_A += dt / 1e-4 * (applied_V - 0.01005 * speed - 0.16 * current_A);
    if (!drive.energised || current_A < 0.0) current_A = 0.0;  // diodes let nothing flow back
    bus_A_ = drive.duty * current_A;
    const double friction_Nm = speed > 1.0 ? 0.01005 : 0.0;
    speed += dt / 3.752e-5 * (0.01005 * current_A - friction_Nm - point().CP * speed * speed);
    speed = std::max(speed, 0.0);
  }

  double bus_A_ = 0.0;
  std::mt19937 random_{1};
  std::normal_distribution<double> normal_;
};

}  // namespace fw::esc
