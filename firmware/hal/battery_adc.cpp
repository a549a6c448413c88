#include "firmware/hal/battery_adc.hpp"

#include "firmware/hal/pins.hpp"
#include "firmware/hal/registers.hpp"

namespace fw::hal {

using namespace hw;

constinit BatteryAdc battery_adc;

void BatteryAdc::init() {
  constexpr std::uint32_t kChannel = 10;
  RCC::AHB1ENR::set(RCC::GPIOCEN);
  RCC::APB2ENR::set(RCC::ADC1EN);
  BatterySense::analog();
  ADC1::CCR::write(ADC1::ADCPRE_DIV4);  // 21 MHz, 36 at most
  ADC1::SMPR1::write(ADC1::SMP_56);
  ADC1::SQR1::write(0);  // one conversion
  ADC1::SQR3::write(kChannel);
  ADC1::CR2::write(ADC1::ADON);
}

std::optional<float> BatteryAdc::next_V() {
  constexpr float kVoltsPerCount = 5.7f * 3.3f / 4096.0f;
  std::optional<float> voltage_V;
  if (ADC1::SR::has(ADC1::EOC)) voltage_V = kVoltsPerCount * static_cast<float>(ADC1::DR::read());
  ADC1::CR2::set(ADC1::SWSTART);
  return voltage_V;
}

}  // namespace fw::hal
