// A CAN bus on which the board has no device, and firmware that sends on it.
#pragma once
#include <functional>

#include "io_bridges/devices/bus.hpp"
#include "io_bridges/qemu/stm32/chip_model.hpp"

namespace whirl::board {

// The first frame that firmware sends on a CAN bus with no device at all is a finding: nobody
// acknowledges it, and it leaves no other trace.
void watch_empty_can(const std::function<bool(int bus)>& used, stm32::ChipModel& chip,
                     const io::FindingSink& finding);

}  // namespace whirl::board
