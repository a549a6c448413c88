// From the name of a part to the model of its peripherals.
#pragma once
#include <memory>

#include "io_bridges/qemu/board/parts.hpp"
#include "io_bridges/qemu/stm32/chip_model.hpp"

namespace whirl::board {

std::unique_ptr<stm32::ChipModel> make_chip(const Part& part, const stm32::ChipHost& host);

}  // namespace whirl::board
