// The heading that a vehicle must have for its accelerometer and its receiver to tell of one motion.
//
//   Model    what the accelerometer feels along the floor, summed from one solution to the next and turned by the heading's
//            error, is the change of the receiver's velocity: D v = e^(i error) D u
//   Error    arg of C = sum conj(D u) D v, over some three seconds
//   Judged   where sum |D u|^2 is above 1 (m/s)^2, as by 1.3 m/s^2 for three seconds: not in a hover, soon in a spiral; and
//            |C| at least 0.7 of it: both of one motion
//   Wrong    by over 40 degrees: less of it is flown with, and a receiver's noise of 0.1 m/s is 5 degrees
//   Source   written for this firmware from Newton's law; the idea of a heading from GPS velocity is the field's
#pragma once
#include <array>

#include "firmware/math.hpp"

namespace fw {

class HeadingByMotion {
 public:
  void forget() {
    known_ = false;
    same_ = turned_ = energy_ = 0.0f;
  }
  // Each step: the acceleration in W along the floor by the heading that is flown by.
  void feel(const Vector3& a_W_mps2, float dt_s) {
    const float north = north_[newest_] + dt_s * a_W_mps2.x();
    const float east = east_[newest_] + dt_s * a_W_mps2.y();
    newest_ = (newest_ + 1) % kHistory;
    north_[newest_] = north;
    east_[newest_] = east;
  }
  // A velocity as it was age_s ago. By how much the heading is wrong, or 0.
  float compare(const Vector3& v_W_mps, float age_s) {
    constexpr float kKept = 0.93f, kLeast = 1.0f, kCoherent = 0.7f, kWrong_rad = 0.7f;
    const auto steps = static_cast<unsigned>(std::lround(std::clamp(age_s, 0.0f, 0.3f) / 0.005f));
    const unsigned then = (newest_ + kHistory - steps) % kHistory;
    const float du_n = north_[then] - last_.u_n, du_e = east_[then] - last_.u_e;
    const float dv_n = v_W_mps.x() - last_.v_n, dv_e = v_W_mps.y() - last_.v_e;
    const bool first = !known_;
    last_ = {north_[then], east_[then], v_W_mps.x(), v_W_mps.y()};
    known_ = true;
    if (first) return 0.0f;
    same_ = kKept * same_ + du_n * dv_n + du_e * dv_e;
    turned_ = kKept * turned_ + du_n * dv_e - du_e * dv_n;
    energy_ = kKept * energy_ + du_n * du_n + du_e * du_e;
    const bool judged = energy_ > kLeast && same_ * same_ + turned_ * turned_ >
                                                kCoherent * kCoherent * energy_ * energy_;
    const float error_rad = std::atan2(turned_, same_);
    return judged && std::abs(error_rad) > kWrong_rad ? error_rad : 0.0f;
  }

 private:
  static constexpr unsigned kHistory = 64;  // steps of 5 ms
  struct Solution {
    float u_n = 0.0f, u_e = 0.0f, v_n = 0.0f, v_e = 0.0f;
  };
  bool known_ = false;
  float same_ = 0.0f, turned_ = 0.0f, energy_ = 0.0f;
  Solution last_;
  std::array<float, kHistory> north_{}, east_{};  // of what has been felt, summed
  unsigned newest_ = 0;
};

}  // namespace fw
