// Whom of two receivers the pilot is heard by, the one with a sum signal or the one with SBUS: whichever speaks.
//
//   Rule    the first that gives a frame is heard, and then no other while the vehicle is armed: two
//           receivers may be bound to two transmitters. Disarmed, another takes its place half a second
//           after it fell silent
//   Frames  counted are those that carry news of the sticks
#pragma once
#include <cstdint>

namespace fw {

enum class ReceiverKind : std::uint8_t { none, cppm, sbus };

class ReceiverChoice {
 public:
  // A frame of this one: does it count?
  bool hears(ReceiverKind kind, std::uint32_t now_us, bool armed) {
    const bool other = heard_ != ReceiverKind::none && heard_ != kind;
    if (other && (armed || now_us - last_us_ < kSilent_us)) return false;
    heard_ = kind;
    last_us_ = now_us;
    return true;
  }

 private:
  static constexpr std::uint32_t kSilent_us = 500'000;

  ReceiverKind heard_ = ReceiverKind::none;
  std::uint32_t last_us_ = 0;
};

}  // namespace fw
