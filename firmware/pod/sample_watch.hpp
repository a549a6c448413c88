// Which samples of the host came, which are lost and which were late: by their sequence numbers and the
// time between them. The last 32 stand in a mask, so that the host can mark its own data.
//
//   Lost   its number never came; one that is overtaken counts so, too
//   Late   more than 250 us beyond a period. Over CAN one frame of others may go first (160 us) and three frames have
//          stuff bits or not (87); a turn of the main loop at its longest (60) on top of both is told as late, too
#pragma once
#include <cstdint>

namespace fw::pod {

class SampleWatch {
 public:
  static constexpr std::uint32_t kPeriod_us = 1000, kLate_us = kPeriod_us + 250;

  void came(std::uint8_t sequence, std::uint32_t now_us) {
    if (!begun_) {
      begun_ = true;
    } else {
      const auto step = static_cast<std::uint8_t>(sequence - last_);
      const std::uint32_t missing = step == 0 ? 0u : step - 1u;
      lost_ += missing;
      for (std::uint32_t i = 0; i < missing && i < 32; ++i) shift(true);
      const bool late = missing == 0 && now_us - last_us_ > kLate_us;
      if (late) ++late_count_;
      shift(late);
    }
    last_ = sequence;
    last_us_ = now_us;
  }
  std::uint32_t lost() const { return lost_; }
  std::uint32_t late() const { return late_count_; }
  std::uint32_t flagged() const { return mask_; }  // bit 0: the newest sample
  std::uint8_t last() const { return last_; }
  bool overdue(std::uint32_t now_us) const { return begun_ && now_us - last_us_ > kLate_us; }

 private:
  void shift(bool flagged) { mask_ = mask_ << 1 | (flagged ? 1u : 0u); }

  bool begun_ = false;
  std::uint8_t last_ = 0;
  std::uint32_t last_us_ = 0, lost_ = 0, late_count_ = 0, mask_ = 0;
};

}  // namespace fw::pod
