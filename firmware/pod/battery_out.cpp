#include "firmware/pod/battery_out.hpp"

#include <algorithm>

#include "firmware/hal/registers.hpp"
#include "firmware/pod/pod_pins.hpp"

namespace fw::pod {

using namespace hw;

constinit BatteryOut battery_out;

void BatteryOut::start() {
  RCC::AHB1ENR::set(RCC::GPIOAEN);
  RCC::APB1ENR::set(RCC::DACEN);
  BatteryLevel::analog();
}

void BatteryOut::set(std::uint32_t level) {
  constexpr std::uint32_t kMost = 4095;
  DAC::DHR12R1::write(std::min(level, kMost));
  if (on_) return;
  on_ = true;
  DAC::CR::write(DAC::EN1);
}

}  // namespace fw::pod
