// STM32F103 of medium density (F103CB): all register blocks of the part, wired to each other and to
// its pins (RM0008).
#pragma once
#include <memory>

#include "io_bridges/qemu/stm32/chip_model.hpp"

namespace whirl::stm32 {

std::unique_ptr<ChipModel> make_stm32f103(const ChipHost& host);

}  // namespace whirl::stm32
