// Pins: one call per way in which this board uses one.
#pragma once
#include <cstdint>
#include <type_traits>

#include "firmware/hal/registers.hpp"

namespace fw::hal {

enum class Pull : std::uint32_t { none = 0, up = 1 };

template <typename Port, unsigned kPin>
struct Pin {
  static void alternate(std::uint32_t function, bool open_drain, Pull pull) {
    using Afr = std::conditional_t<(kPin < 8), typename Port::AFRL, typename Port::AFRH>;
    Afr::replace(0xFu << (4 * (kPin % 8)), function << (4 * (kPin % 8)));
    shape(open_drain, pull);
    Port::MODER::replace(3u << (2 * kPin), 2u << (2 * kPin));
  }
  static void output(bool open_drain, bool level) {
    set(level);
    shape(open_drain, open_drain ? Pull::up : Pull::none);
    Port::MODER::replace(3u << (2 * kPin), 1u << (2 * kPin));
  }
  static void input(Pull pull) {
    Port::MODER::replace(3u << (2 * kPin), 0);
    Port::PUPDR::replace(3u << (2 * kPin), static_cast<std::uint32_t>(pull) << (2 * kPin));
  }
  static void analog() { Port::MODER::set(3u << (2 * kPin)); }
  static void set(bool level) { Port::BSRR::write(1u << (level ? kPin : kPin + 16)); }
  static bool level() { return Port::IDR::has(1u << kPin); }

 private:
  static void shape(bool open_drain, Pull pull) {
    Port::OTYPER::replace(1u << kPin, open_drain ? 1u << kPin : 0u);
    Port::OSPEEDR::replace(3u << (2 * kPin), 2u << (2 * kPin));
    Port::PUPDR::replace(3u << (2 * kPin), static_cast<std::uint32_t>(pull) << (2 * kPin));
  }
};

// PX4FMU v1; the ESCs hang on the expansion header.
using ImuSck = Pin<hw::GPIOA, 5>;
using ImuMiso = Pin<hw::GPIOA, 6>;
using ImuMosi = Pin<hw::GPIOA, 7>;
using ImuSelect = Pin<hw::GPIOB, 0>;
using ImuReady = Pin<hw::GPIOC, 3>;      // by the jumper JP6
using BatterySense = Pin<hw::GPIOC, 0>;  // 10 k of 57 k
using CardSelect = Pin<hw::GPIOA, 4>;
using CardSck = Pin<hw::GPIOC, 10>;
using CardMiso = Pin<hw::GPIOC, 11>;
using CardMosi = Pin<hw::GPIOB, 5>;
using EscScl = Pin<hw::GPIOA, 8>;
using EscSda = Pin<hw::GPIOC, 9>;
using CanRx = Pin<hw::GPIOB, 12>;  // logic level on the header: the transceiver is outside
using CanTx = Pin<hw::GPIOB, 13>;
using SensorScl = Pin<hw::GPIOB, 10>;
using SensorSda = Pin<hw::GPIOB, 11>;
using ReceiverPulses = Pin<hw::GPIOA, 10>;
using ReceiverSbus = Pin<hw::GPIOB, 7>;  // behind an inverter
using RadioTx = Pin<hw::GPIOA, 2>;
using RadioRx = Pin<hw::GPIOA, 3>;
using GpsTx = Pin<hw::GPIOC, 6>;
using GpsRx = Pin<hw::GPIOC, 7>;
using LedAmber = Pin<hw::GPIOB, 14>;  // lit when low
using LedBlue = Pin<hw::GPIOB, 15>;   // lit when low

}  // namespace fw::hal
