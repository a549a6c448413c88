// What of the chip decides how long an instruction takes: its clocks and its flash interface, as the
// firmware has set them up at this moment.
#pragma once
#include "io_bridges/qemu/cycles/flash_timing.hpp"

namespace whirl::board {

struct CoreTiming {
  double hclk_Hz = 0.0, pclk1_Hz = 0.0, pclk2_Hz = 0.0;
  cycles::FlashTiming flash;
  bool operator==(const CoreTiming&) const = default;
};

}  // namespace whirl::board
