#include "firmware/esc/image/sampling.hpp"

#include "firmware/esc/image/registers.hpp"

namespace fw::esc::sampling {
namespace {

using namespace f103;

constexpr std::uint32_t kPhaseChannel = 1, kBusChannel = 4, kShuntChannel = 5;
constexpr std::uint32_t kSample_7_5_cycles = 1;

// Two injected conversions are ranks 3 and 4 of JSQR (RM0008 11.12.12).
constexpr std::uint32_t sequence(std::uint32_t first, std::uint32_t second) {
  return 1u << 20 | second << 15 | first << 10;
}

template <typename A>
void power_up() {
  A::CR2::write(A::ADON);
  A::CR2::set(A::RSTCAL);
  while (A::CR2::has(A::RSTCAL)) {
  }
  A::CR2::set(A::CAL);
  while (A::CR2::has(A::CAL)) {
  }
  std::uint32_t times = 0;
  for (unsigned channel = 1; channel <= 5; ++channel) times |= kSample_7_5_cycles << (3 * channel);
  A::SMPR2::write(times);
}

void clear() {
  ADC1::SR::write(~ADC1::JEOC);
  ADC2::SR::write(~ADC2::JEOC);
}

}  // namespace

void start() {
  for (unsigned pin = 1; pin <= 5; ++pin) GPIOA::configure(pin, kAnalog);
  RCC::APB2ENR::set(RCC::ADC1EN | RCC::ADC2EN);
  power_up<ADC1>();
  power_up<ADC2>();
  ADC1::CR1::write(ADC1::SCAN | ADC1::JEOCIE | ADC1::DUALMOD_INJECTED);
  ADC2::CR1::write(ADC2::SCAN);
  ADC2::CR2::set(ADC2::JEXTTRIG | ADC2::JEXTSEL_JSWSTART);  // follows ADC1
  watch_floating(2);
  ADC1::CR2::set(ADC1::JEXTTRIG | ADC1::JEXTSEL_TIM4_TRGO);
  Nvic<Irq::ADC1_2>::enable(kPrioritySampling);
}

void select_floating(std::uint8_t phase) {
  ADC1::JSQR::write(sequence(kPhaseChannel + phase, kBusChannel));
}

void watch_floating(std::uint8_t phase) {
  select_floating(phase);
  ADC2::JSQR::write(sequence(kShuntChannel, kShuntChannel));
}

void watch_phases() {
  ADC1::JSQR::write(sequence(kPhaseChannel, kPhaseChannel + 1));
  ADC2::JSQR::write(sequence(kPhaseChannel + 2, kBusChannel));
}

Sample read() {
  const Sample sample{static_cast<int>(ADC1::JDR1::read()), static_cast<int>(ADC1::JDR2::read()),
                      static_cast<int>(ADC2::JDR1::read())};
  clear();
  return sample;
}

Phases take_phases() {
  const Phases phases{static_cast<int>(ADC1::JDR1::read()), static_cast<int>(ADC1::JDR2::read()),
                      static_cast<int>(ADC2::JDR1::read()), static_cast<int>(ADC2::JDR2::read())};
  clear();
  return phases;
}

}  // namespace fw::esc::sampling
