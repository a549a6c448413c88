// Allan deviation of the simulated IMU against its configured densities.
#include <cmath>

#include "plant/sensors/imu.hpp"
#include "plant/validation/validation.hpp"

namespace whirl::plant {
namespace {

constexpr double kSampling_s = 0.01, kFloor = 0.664;  // of bias instability [IEEE952, annex C]

double allan_deviation(const std::vector<double>& x, std::size_t n) {
  double before = 0.0, sum = 0.0;
  std::size_t count = 0;
  for (std::size_t start = 0; start + n <= x.size(); start += n) {
    double mean = 0.0;
    for (std::size_t k = 0; k < n; ++k) mean += x[start + k] / static_cast<double>(n);
    if (start > 0) sum += (mean - before) * (mean - before), ++count;
    before = mean;
  }
  return std::sqrt(0.5 * sum / static_cast<double>(count));
}

Proof allan(const std::string& what, const std::string& unit, const std::vector<double>& x,
            const TriadParams& p) {
  Curve model{what, {}, {}}, want{"configured", {}, {}};
  double worst = 0.0;
  for (std::size_t n : {2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000}) {
    const double tau = static_cast<double>(n) * kSampling_s;
    const double configured =
        std::hypot(p.noise_density / std::sqrt(tau), kFloor * p.bias_instability);
    const double got = allan_deviation(x, n);
    model.x.push_back(tau), model.y.push_back(got);
    want.x.push_back(tau), want.y.push_back(configured);
    worst = std::max(worst, std::abs(100.0 * (got / configured - 1.0)));
  }
  return {.title = "Allan deviation of the " + what,
          .x_label = "averaging time / s",
          .y_label = unit,
          .source = "IEEE952, annex C",
          .model = {model},
          .reference = {want},
          .figures = {{"worst, 0.02 to 20 s", worst, 10.0, "%"}}};
}

}  // namespace

std::vector<Proof> sensor_proofs() {
  const ImuParams params = mpu6000_physics();
  Imu imu(params, 5);
  std::vector<double> accel, gyro;
  ImuMotion rest;
  rest.specific_force_B_mps2.z() = -9.80665;
  for (int k = 1; k <= 2'000'000; ++k) {
    const ImuSample s = imu.sample(k * kSampling_s, rest);
    accel.push_back(s.specific_force_S_mps2.x());
    gyro.push_back(s.rate_S_radps.y());
  }
  return {allan("accelerometer", "m/s^2", accel, params.accelerometer),
          allan("gyroscope", "rad/s", gyro, params.gyroscope)};
}

}  // namespace whirl::plant
