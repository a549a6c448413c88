// Which of a receiver's solutions are believed, and whether they still carry a flight.
//
//   Gate     a solution that lies further from the estimate than kGate_m, and as much more as an unaided
//            estimate may have drifted since the last one that was believed, or whose velocity differs by more
//            than kGate_mps, is not used: it stays out however long it lasts, until it comes back or the
//            vehicle rests
//   Fresh    believed within the last second
//   Stuck    in the air, the same place and velocity to the last digit kMostSame times in a row is no
//            measurement: it has a centimetre's resolution, and noise of decimetres. On the ground a receiver may
//            hold them
//   Notices  a jump, a jammed receiver, a false velocity above the gate, one that has stopped measuring
//   Blind    to a place that drifts away together with its velocity, below the gate: no sensor on board tells
//            that from wind
#pragma once
#include <algorithm>
#include <cstdint>

#include "firmware/estimation/gps_frame.hpp"
#include "firmware/math.hpp"

namespace fw {

class GpsGuard {
 public:
  static constexpr std::uint32_t kLost_ms = 1000, kNever = 1'000'000;
  static constexpr float kGate_m = 3.0f, kGate_mps = 2.0f;

  static constexpr unsigned kMostSame = 3;  // 0.6 s at 5 Hz

  void tick() { ++believed_ms_; }
  void forget() {
    believed_ms_ = kNever;
    in_row_ = 0;
  }
  // Asked of each solution once. True: it is as those before it.
  bool stuck(const GpsSolution& solution) {
    const bool same = solution.latitude_e7_deg == last_.latitude_e7_deg &&
                      solution.longitude_e7_deg == last_.longitude_e7_deg &&
                      solution.height_mm == last_.height_mm && solution.v_W_mps == last_.v_W_mps;
    same_ = same ? std::min(same_ + 1, kMostSame) : 0;
    last_ = solution;
    return same_ == kMostSame;
  }
  // The innovations of a solution. False: not to be used.
  bool believe(const Vector3& p_W_m, const Vector3& v_W_mps) {
    constexpr float kDrift_mps = 0.5f, kMostDrift_m = 5.0f, kDrift_mps2 = 0.15f,
                    kMostDrift_mps = 1.5f;
    const float gate_m = kGate_m + std::min(kDrift_mps * age_s(), kMostDrift_m);
    const float gate_mps = kGate_mps + std::min(kDrift_mps2 * age_s(), kMostDrift_mps);
    const bool good = p_W_m.head<2>().norm() < gate_m && v_W_mps.norm() < gate_mps;  // nor NaN
    in_row_ = good ? in_row_ + 1 : 0;
    if (good) believed_ms_ = 0;
    return good;
  }
  bool fresh() const { return believed_ms_ < kLost_ms; }
  std::uint32_t in_row() const { return in_row_; }
  float age_s() const { return 1e-3f * static_cast<float>(believed_ms_); }

 private:
  std::uint32_t believed_ms_ = kNever, in_row_ = 0;
  GpsSolution last_;
  unsigned same_ = 0;
};

}  // namespace fw
