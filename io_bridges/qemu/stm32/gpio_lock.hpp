// LCKR of a GPIO port: pins whose configuration stays as it is until the next reset.
//
//   Key     write 1, 0, 1 into LCKK with the same pins in the low half, then read
//   Source  RM0008 9.2.7; RM0090 8.4.8
#pragma once
#include <cstdint>

namespace whirl::stm32 {

class GpioLock {
 public:
  bool holds(int pin) const { return (value_ & LCKK) != 0 && ((value_ >> pin) & 1) != 0; }

  std::uint32_t read() {
    if (step_ == 3) {
      value_ |= LCKK;
      step_ = 0;
    }
    return value_;
  }
  void write(std::uint32_t value) {
    if ((value_ & LCKK) != 0) return;
    const bool key = (value & LCKK) != 0;
    const bool same = (value & 0xFFFF) == value_;
    if (step_ == 1 && !key && same) {
      step_ = 2;
    } else if (step_ == 2 && key && same) {
      step_ = 3;
    } else {
      step_ = key ? 1 : 0;
      value_ = value & 0xFFFF;
    }
  }
  void reset() {
    value_ = 0;
    step_ = 0;
  }

 private:
  static constexpr std::uint32_t LCKK = 1u << 16;
  std::uint32_t value_ = 0;
  int step_ = 0;  // writes of the key that have come in order
};

}  // namespace whirl::stm32
