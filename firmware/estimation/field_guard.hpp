// Which readings of the magnetometer may turn the heading.
//
//   Learns   at rest: the field in W, by the attitude of then, over a second
//   Gate     in flight a reading that lies further from that than a quarter of its length, turned into B by the
//            attitude that is flown by, is not used: it tells of iron, of a magnet or of a broken part. What
//            uncompensated motors add is 10 uT of 58, and 14 uT across a level field of 23 is the heading's worst
//            error that passes: 37 degrees
//   Again    after half a second of readings within the gate
//   Notices  strength, dip and a heading that jumps, each alone
//   Blind    to a disturbance that is there at rest already and stays, and to one that turns the level field slowly
//            without changing its length: what comes of it is told by the motion (heading_by_motion.hpp), and then no
//            reading is believed until the vehicle rests
#pragma once
#include <algorithm>
#include <cstdint>

#include "firmware/math.hpp"

namespace fw {

class FieldGuard {
 public:
  static constexpr float kGate = 0.25f;
  static constexpr std::uint32_t kLost_ms = 200, kNever = 1'000'000;
  static constexpr unsigned kAgain = 38;  // 0.5 s at 75 Hz

  void tick() { believed_ms_ = std::min(believed_ms_ + 1, kNever); }
  // A reading at rest is the field, once it is one.
  void rests(const Vector3& field_W) {
    constexpr float kShare = 1.0f / 75.0f;
    if (!std::isfinite(field_W.sum())) return;
    learnt_W_ += (known_ ? kShare : 1.0f) * (field_W - learnt_W_);
    known_ = true;
    misleads_ = false;
    out_ = 0;
    believed_ms_ = 0;
  }
  void misleads() { misleads_ = true; }
  // A reading in flight, in W by the attitude that is flown by. False: not to be used.
  bool believe(const Vector3& field_W) {
    const bool within = (field_W - learnt_W_).norm() < kGate * learnt_W_.norm();  // nor NaN
    if (misleads_ || (known_ && !within)) {
      out_ = kAgain;
      return false;
    }
    if (out_ > 0 && --out_ > 0) return false;
    believed_ms_ = 0;
    return true;
  }
  // One was believed within the last 0.2 s.
  bool fresh() const { return !misleads_ && believed_ms_ < kLost_ms; }

 private:
  bool known_ = false, misleads_ = false;
  unsigned out_ = 0;  // readings within the gate that are still asked for
  std::uint32_t believed_ms_ = kNever;
  Vector3 learnt_W_ = Vector3::Zero();
};

}  // namespace fw
