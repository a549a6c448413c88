#include "io_bridges/qemu/board/chip_factory.hpp"

#include "base/check.hpp"
#include "io_bridges/qemu/board/bench_chip.hpp"
#include "io_bridges/qemu/stm32/stm32f103.hpp"
#include "io_bridges/qemu/stm32/stm32f405.hpp"

namespace whirl::board {

std::unique_ptr<stm32::ChipModel> make_chip(const Part& part, const stm32::ChipHost& host) {
  if (part.mcu == "stm32f405rg") return stm32::make_stm32f405(host);
  if (part.mcu == "stm32f103cb") return stm32::make_stm32f103(host);
  if (part.mcu == "bench_m4") return make_bench_chip(host);
  WHIRL_CHECK(false, part.mcu);
}

}  // namespace whirl::board
