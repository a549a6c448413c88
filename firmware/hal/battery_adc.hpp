// The battery's voltage at PC0, by ADC1's channel 10: one conversion when asked, fetched at the next call.
//
//   Scale   47 k / 10 k divider, 12 bits of the 3.3 V supply (whose regulator is good to 1 or 2 %)
//   Time    56 + 12 cycles of 21 MHz, 3.2 us: long over when the next call comes
//   Source  RM0090 chapter 13; the board's schematics
#pragma once
#include <optional>

namespace fw::hal {

class BatteryAdc {
 public:
  void init();
  // The conversion that the call before began, and begins another; nothing if it has not ended.
  std::optional<float> next_V();
};

extern BatteryAdc battery_adc;

}  // namespace fw::hal
