// The level that a divider would bring to the flight controller's ADC from the battery: the DAC's channel 1 (PA4).
//
//   Range    0 to 4095 of VDDA, behind the output buffer: on silicon 0.2 V to VDDA - 0.2 V, levels beyond are held there
//            (data sheet, DAC characteristics); it drives 5 kOhm
//   Before   the host has told a level the pin is analog and not driven
//   Source   RM0090, ch. 14
#pragma once
#include <cstdint>

namespace fw::pod {

class BatteryOut {
 public:
  void start();
  void set(std::uint32_t level);  // more is the most

 private:
  bool on_ = false;
};

extern BatteryOut battery_out;

}  // namespace fw::pod
