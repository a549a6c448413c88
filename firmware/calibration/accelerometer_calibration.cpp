#include "firmware/calibration/accelerometer_calibration.hpp"

#include "firmware/calibration/least_squares.hpp"
#include "firmware/config/vehicle.hpp"

namespace fw {
namespace {

// A hand sways: 0.02 rad of tilt, 0.05 rad/s.
constexpr StillWindow::Limits kHeldStill{0.5f, 0.15f, 24};
constexpr float kFacing_mps2 = 8.0f;  // within some 35 degrees
constexpr float kMilli_g = 1e-3f * config::kGravity_mps2;
constexpr float kMostOffset_mps2[] = {85.0f * kMilli_g, 85.0f * kMilli_g, 140.0f * kMilli_g};
constexpr float kMostScaleError = 0.05f;

// Something that points up has an accelerometer there read positive along it.
AccelerometerCalibration::Side side_of(const Vector3& a_B_mps2) {
  Eigen::Index axis = 0;
  if (a_B_mps2.cwiseAbs().maxCoeff(&axis) < kFacing_mps2)
    return AccelerometerCalibration::Side::none;
  return static_cast<AccelerometerCalibration::Side>(2 * axis + (a_B_mps2[axis] > 0.0f ? 0 : 1));
}

}  // namespace

AccelerometerCalibration::Side AccelerometerCalibration::add(const Vector3& a_B_mps2,
                                                             const Vector3& w_B_radps) {
  if (window_.add(a_B_mps2, w_B_radps, kHeldStill) != StillWindow::Now::complete) return Side::none;
  const Side side = side_of(window_.a_mean_B_mps2());
  if (side == Side::none) return side;
  const auto i = static_cast<std::size_t>(side);
  if (have_[i]) return Side::none;
  have_[i] = true;
  mean_B_mps2_[i] = window_.a_mean_B_mps2();
  ++done_;
  return side;
}

bool AccelerometerCalibration::solve(Vector3& offset_B_mps2, Vector3& scale) const {
  constexpr float g = config::kGravity_mps2, kGood = 1e-4f;
  constexpr int kSteps = 8;
  Vector3 o, s;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto pair = static_cast<std::size_t>(2 * i);
    const float up = mean_B_mps2_[pair][i], down = mean_B_mps2_[pair + 1][i];
    o[i] = 0.5f * (up + down);
    s[i] = 2.0f * g / (up - down);
  }
  float worst = 0.0f;
  for (int step = 0; step <= kSteps; ++step) {
    LeastSquares newton;
    newton.start(kSides);
    worst = 0.0f;
    for (const Vector3& a : mean_B_mps2_) {
      const Vector3 f = s.cwiseProduct(a - o) / g;
      const float error = 1.0f - f.squaredNorm();
      worst = std::max(worst, std::abs(error));
      // By o / g, then by s.
      std::array<float, kSides> row{};
      for (Eigen::Index i = 0; i < 3; ++i) {
        row[static_cast<std::size_t>(i)] = -2.0f * f[i] * s[i];
        row[static_cast<std::size_t>(i) + 3] = 2.0f * f[i] * f[i] / s[i];
      }
      newton.add(row, {&error, 1});
    }
    if (worst < kGood * 0.1f) break;
    LeastSquares::Solution p{};
    if (!newton.solve(0, p)) return false;
    o += g * Vector3(p[0], p[1], p[2]);
    s += Vector3(p[3], p[4], p[5]);
  }
  if (!(worst < kGood)) return false;
  const bool possible = (Vector3::Map(kMostOffset_mps2) - o.cwiseAbs()).minCoeff() >= 0.0f &&
                        (s - Vector3::Ones()).cwiseAbs().maxCoeff() <= kMostScaleError;
  if (!possible) return false;
  offset_B_mps2 = o;
  scale = s;
  return true;
}

}  // namespace fw
