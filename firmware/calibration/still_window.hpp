// Whether the vehicle is held still, and the means of its inertial sensor meanwhile.
//
//   In       a sample each millisecond
//   Method   means over blocks of 50 ms, by which white noise (0.07 m/s^2 a sample) falls to 0.015 m/s^2: each
//            is compared with the first. Not with zero, as zero points are what is looked for
//   Not seen a steady turn about the vertical: neither sensor changes by it
#pragma once
#include "firmware/math.hpp"

namespace fw {

class StillWindow {
 public:
  static constexpr int kBlock_ms = 50;
  struct Limits {
    float acceleration_mps2, rate_radps;
    int blocks;
  };
  enum class Now : std::uint8_t { gathering, moved, complete };

  void restart() { *this = {}; }

  // moved: the window begins anew by itself; complete: the means are of the whole window.
  Now add(const Vector3& a_B_mps2, const Vector3& w_B_radps, const Limits& limits) {
    a_block_ += a_B_mps2;
    w_block_ += w_B_radps;
    if (++in_block_ < kBlock_ms) return Now::gathering;
    const Vector3 a = a_block_ / kBlock_ms, w = w_block_ / kBlock_ms;
    in_block_ = 0;
    a_block_.setZero();
    w_block_.setZero();
    if (blocks_ == 0) {
      a_first_ = a;
      w_first_ = w;
    }
    const bool moved = (a - a_first_).cwiseAbs().maxCoeff() > limits.acceleration_mps2 ||
                       (w - w_first_).cwiseAbs().maxCoeff() > limits.rate_radps;
    if (moved) {
      restart();
      return Now::moved;
    }
    a_sum_ += a;
    w_sum_ += w;
    if (++blocks_ < limits.blocks) return Now::gathering;
    a_mean_ = a_sum_ / static_cast<float>(blocks_);
    w_mean_ = w_sum_ / static_cast<float>(blocks_);
    blocks_ = 0;
    a_sum_.setZero();
    w_sum_.setZero();
    return Now::complete;
  }
  const Vector3& a_mean_B_mps2() const { return a_mean_; }
  const Vector3& w_mean_B_radps() const { return w_mean_; }
  int blocks() const { return blocks_; }

 private:
  Vector3 a_block_ = Vector3::Zero(), w_block_ = Vector3::Zero();
  Vector3 a_first_ = Vector3::Zero(), w_first_ = Vector3::Zero();
  Vector3 a_sum_ = Vector3::Zero(), w_sum_ = Vector3::Zero();
  Vector3 a_mean_ = Vector3::Zero(), w_mean_ = Vector3::Zero();
  int in_block_ = 0, blocks_ = 0;
};

}  // namespace fw
