// The pod's pins, on a bare STM32F405 board (Olimex STM32-H405). SPI1 on its second set, so that PA4
// is the DAC's.
#pragma once
#include "firmware/hal/pins.hpp"

namespace fw::pod {

using SlaveSelect = hal::Pin<hw::GPIOA, 15>;
using SlaveSck = hal::Pin<hw::GPIOB, 3>;
using SlaveMiso = hal::Pin<hw::GPIOB, 4>;
using SlaveMosi = hal::Pin<hw::GPIOB, 5>;
using DataReady = hal::Pin<hw::GPIOC, 4>;
using SensorScl = hal::Pin<hw::GPIOB, 8>;  // I2C1: barometer and magnetometer
using SensorSda = hal::Pin<hw::GPIOB, 9>;
using EscScl12 = hal::Pin<hw::GPIOB, 10>;  // I2C2 and I2C3, soldered together: two addresses each
using EscSda12 = hal::Pin<hw::GPIOB, 11>;
using EscScl34 = hal::Pin<hw::GPIOA, 8>;
using EscSda34 = hal::Pin<hw::GPIOC, 9>;
using GpsTx = hal::Pin<hw::GPIOC, 6>;
using GpsRx = hal::Pin<hw::GPIOC, 7>;
using RadioTx = hal::Pin<hw::GPIOC, 10>;
using RadioRx = hal::Pin<hw::GPIOC, 11>;
using BatteryLevel = hal::Pin<hw::GPIOA, 4>;  // DAC, channel 1
using SbusTx = hal::Pin<hw::GPIOA, 2>;        // an inverter behind it
using CppmPin = hal::Pin<hw::GPIOB, 6>;
using HostTx = hal::Pin<hw::GPIOA, 9>;
using HostRx = hal::Pin<hw::GPIOA, 10>;

// Who is more urgent than whom (0 is the most urgent). The part on SPI is touched at kPriorityParts only,
// or under a lock of that; those on I2C at kPriorityBus.
enum Priority : std::uint32_t { kPriorityAnswer = 0, kPriorityParts = 1, kPriorityBus = 2 };

}  // namespace fw::pod
