#include "firmware/esc/image/bridge.hpp"

#include "firmware/esc/image/registers.hpp"

namespace fw::esc::bridge {
namespace {

using namespace f103;

// What a step writes, in this order: a commutation may come into a sample, and both are short of time.
struct Pattern {
  std::uint32_t off_A, off_B;  // BSRR: the lower switches but one
  std::uint32_t upper;         // CCER
  std::uint32_t on_A, on_B;    // BSRR: that one
  std::uint8_t floating;
};

constexpr std::uint32_t kAll_lower_B = bit(0 + 16) | bit(1 + 16);
constexpr std::uint32_t kUpper_enable[3] = {TIM4::CC1E, TIM4::CC2E, TIM4::CC3E};

constexpr Pattern pattern(unsigned high, unsigned low) {
  return {
      .off_A = low == 0 ? 0u : bit(7 + 16),
      .off_B = low == 0   ? kAll_lower_B
               : low == 1 ? bit(1 + 16)
                          : bit(0 + 16),
      // A disabled channel lets go of its pin's level: the pin is low by the port's own output then.
      .upper = kUpper_enable[high] | TIM4::CC4E,
      .on_A = low == 0 ? bit(7) : 0u,
      .on_B = low == 0   ? 0u
              : low == 1 ? bit(0)
                         : bit(1),
      .floating = static_cast<std::uint8_t>(3u - high - low)};
}

constexpr Pattern kPatterns[6] = {pattern(0, 1), pattern(0, 2), pattern(1, 2),
                                  pattern(1, 0), pattern(2, 0), pattern(2, 1)};

std::uint32_t duty_counts = 0;

void lower_off() {
  GPIOA::BSRR::write(bit(7 + 16));
  GPIOB::BSRR::write(kAll_lower_B);
}

void write_duty() {
  TIM4::CCR1::write(duty_counts);
  TIM4::CCR2::write(duty_counts);
  TIM4::CCR3::write(duty_counts);
  const std::uint32_t on = duty_counts < kShortest_on ? kShortest_on : duty_counts;
  TIM4::CCR4::write(on - kSample_before_end);
}

}  // namespace

void start() {
  RCC::APB1ENR::set(RCC::TIM2EN | RCC::TIM4EN);
  lower_off();
  GPIOA::configure(7, kOutput);
  GPIOB::configure(0, kOutput);
  GPIOB::configure(1, kOutput);
  TIM4::PSC::write(0);
  TIM4::ARR::write(kPeriod - 1);
  TIM4::CCMR1::write(TIM4::OC1M_PWM1 | TIM4::OC1PE | TIM4::OC2M_PWM1 | TIM4::OC2PE);
  TIM4::CCMR2::write(TIM4::OC3M_PWM1 | TIM4::OC3PE | TIM4::OC4M_PWM2 | TIM4::OC4PE);
  TIM4::CR2::write(TIM4::MMS_OC4REF);
  TIM4::CCER::write(TIM4::CC4E);
  write_duty();
  TIM4::EGR::write(TIM4::UG);
  TIM4::CR1::write(TIM4::ARPE | TIM4::CEN);
  for (unsigned pin : {6u, 7u, 8u}) GPIOB::configure(pin, kAlternate);

  TIM2::PSC::write(kTimer_Hz / 2'000'000 - 1);
  TIM2::ARR::write(0xFFFF);
  TIM2::EGR::write(TIM2::UG);
  TIM2::SR::write(0);
  TIM2::CR1::write(TIM2::CEN);
  Nvic<Irq::TIM2_Global>::enable(kPriorityCommutation);
}

void off() {
  let_go();
  set_duty(0);
}

void let_go() {
  TIM4::CCER::write(TIM4::CC4E);
  lower_off();
}

// Never both switches of a leg: what goes off goes off before anything goes on. A jump of three steps,
// when a start is overtaken, swaps the switches of both legs.
void apply(std::uint8_t step) {
  const Pattern& next = kPatterns[step];
  GPIOA::BSRR::write(next.off_A);
  GPIOB::BSRR::write(next.off_B);
  TIM4::CCER::write(next.upper);
  GPIOA::BSRR::write(next.on_A);
  GPIOB::BSRR::write(next.on_B);
}

void set_duty(std::uint32_t counts) {
  const std::uint32_t wanted = counts > kPeriod ? kPeriod : counts;
  if (wanted == duty_counts) return;  // at 20 kHz, four accesses to a slow bus
  duty_counts = wanted;
  write_duty();
}

std::uint32_t duty() {
  return duty_counts;
}

std::uint32_t counts_of(float share) {
  const float counts = share * static_cast<float>(kPeriod);
  return counts <= 0.0f ? 0u : static_cast<std::uint32_t>(counts);
}

std::uint8_t floating_phase(std::uint8_t step) {
  return kPatterns[step].floating;
}

Ticks now() {
  return static_cast<Ticks>(TIM2::CNT::read());
}

void interrupt_at(Ticks at) {
  TIM2::CCR1::write(at);
  TIM2::SR::write(0);
  TIM2::DIER::write(TIM2::CC1IE);
  const auto left = static_cast<Ticks>(at - now());
  if (left == 0 || left > 0x8000) TIM2::EGR::write(TIM2::CC1G);
}

void acknowledge_interrupt() {
  TIM2::DIER::write(0);
  TIM2::SR::write(0);
}

}  // namespace fw::esc::bridge
