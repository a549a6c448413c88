#include "firmware/estimation/drag_identification.hpp"

#include "firmware/estimation/drag_model.hpp"

namespace fw {
namespace {

constexpr float kSample_s = 0.025f;
constexpr float kPriorSigma_spm = 0.0035f;
// d in units of a_xy / a_z: at the start 5 m/s of wind, then a walk of 1 cm/s in a second.
constexpr float kStart_d = 0.2f, kWalk_d2ps = 0.0004f * 0.0004f;
// The accelerometer's noise and the rotors' shaking in 25 ms: some 0.04 m/s^2 of 1 g.
constexpr float kNoise2 = 0.004f * 0.004f;
constexpr float kUnlikely2 = 16.0f;  // four sigmas
constexpr float kResidual_s = 0.5f;
constexpr float kScatter_s = 3.0f, kScatter_m2ps2 = 0.15f * 0.15f;

}  // namespace

void DragIdentification::start(float drag_spm) {
  x_ = {drag_spm, 0.0f, 0.0f};
  P_.setZero();
  P_(0, 0) = kPriorSigma_spm * kPriorSigma_spm;
  P_(1, 1) = P_(2, 2) = kStart_d * kStart_d;
  pause();
}

void DragIdentification::pause() {
  running_ = false;
}

void DragIdentification::add(const Vector3& a_B_mps2, const Quaternion& q_WB,
                             const Vector3& v_WB_W_mps) {
  if (!running_) {
    running_ = true;
    count_ = 0;
    v_variance_m2ps2_ = 0.0f;
    v_mean_ = v_WB_W_mps.head<2>();
    residual_.setZero();
    P_(1, 1) = P_(2, 2) = kStart_d * kStart_d;
    P_(0, 1) = P_(0, 2) = P_(1, 0) = P_(2, 0) = P_(1, 2) = P_(2, 1) = 0.0f;
  }
  if (count_ == 0) {
    a_sum_.setZero();
    v_sum_.setZero();
  }
  a_sum_ += a_B_mps2;
  v_sum_ += v_WB_W_mps;
  if (++count_ < kSteps) return;
  count_ = 0;
  // Of the velocity, too, only what lies in the rotors' plane.
  Vector3 v_B = q_WB.conjugate() * (v_sum_ / static_cast<float>(kSteps));
  v_B.z() = 0.0f;
  const Eigen::Vector2f felt = a_sum_.head<2>() / a_sum_.z();
  Vector3 y_B = Vector3::Zero();
  y_B.head<2>() = drag_spm() * velocity_through_air(felt, drag_spm());
  update((q_WB * y_B).head<2>(), (q_WB * v_B).head<2>());
}

bool DragIdentification::excited(const Eigen::Vector2f& v_mps) {
  constexpr float kShare = kSample_s / kScatter_s;
  const Eigen::Vector2f off = v_mps - v_mean_;
  v_mean_ += kShare * off;
  v_variance_m2ps2_ += kShare * (off.squaredNorm() - v_variance_m2ps2_);
  return v_variance_m2ps2_ > kScatter_m2ps2;
}

void DragIdentification::update(const Eigen::Vector2f& y, const Eigen::Vector2f& v_mps) {
  const Vector3 x_before = x_;
  const Matrix3 P_before = P_;
  excited_ = excited(v_mps);
  P_(1, 1) += kSample_s * kWalk_d2ps;
  P_(2, 2) += kSample_s * kWalk_d2ps;
  update_axis(0, y.x(), v_mps.x());
  update_axis(1, y.y(), v_mps.y());
  x_.x() = std::clamp(x_.x(), kLeast_spm, kMost_spm);
  if (std::isfinite(x_.sum() + P_.sum() + v_variance_m2ps2_)) return;
  x_ = x_before;
  P_ = P_before;
  pause();
}

// variance: of the residual, as far as it comes from c and d. Of the noise a mean over half a second
// leaves a share.
void DragIdentification::notice_wind(int axis, float residual, float variance) {
  constexpr float kShare = kSample_s / kResidual_s;
  float& mean = residual_[axis];
  mean += kShare * (residual - mean);
  if (mean * mean < kUnlikely2 * (variance + 0.5f * kShare * kNoise2)) return;
  P_(1 + axis, 1 + axis) += mean * mean;
  mean = 0.0f;
}

void DragIdentification::update_axis(int axis, float y, float v_mps) {
  const Vector3 h(v_mps, axis == 0 ? -1.0f : 0.0f, axis == 1 ? -1.0f : 0.0f);
  const float residual = y - h.dot(x_);
  notice_wind(axis, residual, h.dot(P_ * h));
  const Vector3 Ph = P_ * h;
  const float s = h.dot(Ph) + kNoise2;
  Vector3 gain = Ph / s;
  if (!excited_) gain.x() = 0.0f;
  x_ += residual * gain;
  // In Joseph's form: right for any gain.
  const Matrix3 cross = gain * Ph.transpose();
  P_ += s * gain * gain.transpose() - cross - cross.transpose();
}

}  // namespace fw
