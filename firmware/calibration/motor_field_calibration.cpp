#include "firmware/calibration/motor_field_calibration.hpp"

namespace fw {
namespace {

constexpr float kMostResidual_uT = 0.8f;
constexpr float kMost_uTpA = 10.0f, kLeastChange_A = 0.3f, kMostTurned_rad = 0.26f;

}  // namespace

void MotorFieldCalibration::start() {
  *this = {};
  sums_.start(5);
}

int MotorFieldCalibration::motor() const {
  return !done() && phase() % 2 == 1 ? phase() / 2 : -1;
}

void MotorFieldCalibration::add(const Vector3& m_B_uT, const MotorCurrents& current_A) {
  const bool settled = t_s_ - kPhase_s * static_cast<float>(phase()) > kSettle_s;
  if (done() || !settled) return;
  if (sums_.count() == 0) {
    first_uT_ = m_B_uT;
    turned_.setIdentity();
    least_A_ = most_A_ = current_A;
  }
  for (std::size_t i = 0; i < current_A.size(); ++i) {
    least_A_[i] = std::min(least_A_[i], current_A[i]);
    most_A_[i] = std::max(most_A_[i], current_A[i]);
  }
  const Vector3 y = m_B_uT - turned_.conjugate() * first_uT_;
  sums_.add(std::array{current_A[0], current_A[1], current_A[2], current_A[3], 1.0f},
            {y.data(), 3});
}

bool MotorFieldCalibration::solve(std::array<Vector3, 4>& k_B_uTpA) const {
  for (std::size_t i = 0; i < least_A_.size(); ++i) {
    if (!(most_A_[i] - least_A_[i] > kLeastChange_A)) return false;
  }
  if (!(2.0f * turned_.vec().norm() < kMostTurned_rad)) return false;
  std::array<Vector3, 4> k;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto column = static_cast<std::size_t>(axis);
    LeastSquares::Solution p{};
    if (!sums_.solve(column, p)) return false;
    const float mean = sums_.left_over(column, p) / static_cast<float>(sums_.count());
    if (!(std::sqrt(mean) < kMostResidual_uT)) return false;
    for (std::size_t i = 0; i < k.size(); ++i) {
      if (!(std::abs(p[i]) < kMost_uTpA)) return false;
      k[i][axis] = p[i];
    }
  }
  k_B_uTpA = k;
  return true;
}

}  // namespace fw
