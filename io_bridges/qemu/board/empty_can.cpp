#include "io_bridges/qemu/board/empty_can.hpp"

#include <utility>

#include "io_bridges/qemu/stm32/bxcan.hpp"

namespace whirl::board {

void watch_empty_can(const std::function<bool(int bus)>& used, stm32::ChipModel& chip,
                     const io::FindingSink& finding) {
  constexpr int kBuses = 2;
  for (int number = 1; number <= kBuses; ++number) {
    stm32::BxCan* block = chip.can(number);
    if (block == nullptr || used(number)) continue;
    block->bus().on_transfer([number, finding, told = false](const io::CanTransfer& t) mutable {
      if (std::exchange(told, true)) return;
      finding({t.end_ns, "can" + std::to_string(number),
               "the board has no device on this bus: nobody acknowledges a frame"});
    });
  }
}

}  // namespace whirl::board
