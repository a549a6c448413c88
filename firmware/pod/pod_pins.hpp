// The pod's pins, on a bare STM32F405 board (Olimex STM32-H405). SPI1 on its second set, so that PA4 and
// PA5 stay free for the DAC.
#pragma once
#include "firmware/hal/pins.hpp"

namespace fw::pod {

using SlaveSelect = hal::Pin<hw::GPIOA, 15>;
using SlaveSck = hal::Pin<hw::GPIOB, 3>;
using SlaveMiso = hal::Pin<hw::GPIOB, 4>;
using SlaveMosi = hal::Pin<hw::GPIOB, 5>;
using DataReady = hal::Pin<hw::GPIOC, 4>;
using HostTx = hal::Pin<hw::GPIOA, 9>;
using HostRx = hal::Pin<hw::GPIOA, 10>;

// Who is more urgent than whom (0 is the most urgent). The parts are touched at kPriorityParts only, or
// under a lock of that.
enum Priority : std::uint32_t { kPriorityAnswer = 0, kPriorityParts = 1, kPriorityHost = 4 };

}  // namespace fw::pod
