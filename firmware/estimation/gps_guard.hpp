// Which of a receiver's solutions are believed, and whether they still carry a flight.
//
//   Gate     a solution that lies further from the estimate than kGate_m, and as much more as an unaided
//            estimate may have drifted since the last one that was believed, or whose velocity differs by more
//            than kGate_mps, is not used: it stays out however long it lasts, until it comes back or the
//            vehicle rests
//   Fresh    believed within the last second
//   Notices  a jump, a jammed receiver, a false velocity above the gate
//   Blind    to a place that drifts away together with its velocity, below the gate: no sensor on board tells
//            that from wind
#pragma once
#include <cstdint>

#include "firmware/math.hpp"

namespace fw {

class GpsGuard {
 public:
  static constexpr std::uint32_t kLost_ms = 1000, kNever = 1'000'000;
  static constexpr float kGate_m = 3.0f, kGate_mps = 2.0f;

  void tick() { ++believed_ms_; }
  void forget() {
    believed_ms_ = kNever;
    in_row_ = 0;
  }
  // The innovations of a solution. False: not to be used.
  bool believe(const Vector3& p_W_m, const Vector3& v_W_mps) {
    constexpr float kDrift_mps = 0.5f, kMostDrift_m = 5.0f;
    const float gate_m = kGate_m + std::min(kDrift_mps * age_s(), kMostDrift_m);
    const bool good = p_W_m.head<2>().norm() < gate_m && v_W_mps.norm() < kGate_mps;  // nor NaN
    in_row_ = good ? in_row_ + 1 : 0;
    if (good) believed_ms_ = 0;
    return good;
  }
  bool fresh() const { return believed_ms_ < kLost_ms; }
  std::uint32_t in_row() const { return in_row_; }
  float age_s() const { return 1e-3f * static_cast<float>(believed_ms_); }

 private:
  std::uint32_t believed_ms_ = kNever, in_row_ = 0;
};

}  // namespace fw
