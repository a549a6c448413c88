// STM32F405: all register blocks of the part, wired to each other and to its pins (RM0090).
#pragma once
#include <memory>

#include "io_bridges/qemu/stm32/chip_model.hpp"

namespace whirl::stm32 {

std::unique_ptr<ChipModel> make_stm32f405(const ChipHost& host);

}  // namespace whirl::stm32
