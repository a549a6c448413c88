// The two keys that open a FLASH register, in order. After a wrong one it stays shut until the next
// reset.
//
//   Source  PM0075 2.3.1; RM0090 3.6.1
#pragma once
#include <cstdint>

namespace whirl::stm32 {

class FlashKeys {
 public:
  constexpr FlashKeys(std::uint32_t first, std::uint32_t second) : keys_{first, second} {}

  // A key was written while the register is locked. True: that opens it.
  bool open(std::uint32_t key) {
    if (step_ < 0) return false;
    if (key != keys_[step_]) {
      step_ = -1;
      return false;
    }
    step_ = step_ == 0 ? 1 : 0;
    return step_ == 0;
  }
  void reset() { step_ = 0; }

 private:
  std::uint32_t keys_[2];
  int step_ = 0;  // keys that have come; below 0: a wrong one
};

inline constexpr FlashKeys kProgramKeys{0x45670123, 0xCDEF89AB};

}  // namespace whirl::stm32
