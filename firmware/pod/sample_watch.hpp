// Which samples of the host came, which are lost and which were late: by their sequence numbers, and by when they were
// due (sample_clock.hpp). The last 32 stand in a mask, so that the host can mark its own data.
//
//   Lost     its number never came; one that is overtaken counts so, too
//   Overdue  250 us after the next one should have been shown it is not there
#pragma once
#include <cstdint>

namespace fw::pod {

class SampleWatch {
 public:
  static constexpr std::int32_t kOverdue_us = 1000 + 250;

  void came(std::uint8_t sequence, std::uint32_t due_us, bool late) {
    if (!begun_) {
      begun_ = true;
    } else {
      const auto step = static_cast<std::uint8_t>(sequence - last_);
      const std::uint32_t missing = step == 0 ? 0u : step - 1u;
      lost_ += missing;
      for (std::uint32_t i = 0; i < missing && i < 32; ++i) shift(true);
      if (late) ++late_count_;
      shift(late);
    }
    last_ = sequence;
    due_us_ = due_us;
  }
  std::uint32_t lost() const { return lost_; }
  std::uint32_t late() const { return late_count_; }
  std::uint32_t flagged() const { return mask_; }  // bit 0: the newest sample
  std::uint8_t last() const { return last_; }
  bool overdue(std::uint32_t now_us) const {
    return begun_ && static_cast<std::int32_t>(now_us - due_us_) > kOverdue_us;
  }

 private:
  void shift(bool flagged) { mask_ = mask_ << 1 | (flagged ? 1u : 0u); }

  bool begun_ = false;
  std::uint8_t last_ = 0;
  std::uint32_t due_us_ = 0, lost_ = 0, late_count_ = 0, mask_ = 0;
};

}  // namespace fw::pod
