#include "firmware/esc/image/pulse_input.hpp"

#include "firmware/esc/image/registers.hpp"

namespace fw::esc::pulse_input {

using namespace f103;

namespace {

constinit PulseEdges edges;

}  // namespace

void start() {
  RCC::APB2ENR::set(RCC::TIM1EN);
  GPIOA::BSRR::write(bit(8 + 16));
  GPIOA::configure(8, kInputPull);  // down: an open pin gives no pulses
  TIM1::CR1::write(TIM1::CKD_DIV4 | TIM1::URS);
  TIM1::PSC::write(72 - 1);
  TIM1::ARR::write(0xFFFF);
  TIM1::CCMR1::write(TIM1::CC1S_TI1 | TIM1::IC1F_LONGEST | TIM1::CC2S_TI1 | TIM1::IC2F_LONGEST);
  TIM1::CCER::write(TIM1::CC1E | TIM1::CC2E | TIM1::CC2P);
  TIM1::SMCR::write(TIM1::TS_TI1FP1 |
                    TIM1::SMS_RESET);  // a rising edge ends one period, begins one
  TIM1::EGR::write(TIM1::UG);
  TIM1::CR1::set(TIM1::CEN);
}

bool read(Pulse& pulse) {
  const std::uint32_t sr = TIM1::SR::read();
  const auto number = [sr](std::uint32_t once, std::uint32_t again) {
    return (sr & once) == 0 ? 0u : (sr & again) == 0 ? 1u : 2u;
  };
  Captured seen{.rises = number(TIM1::CC1IF, TIM1::CC1OF),
                .falls = number(TIM1::CC2IF, TIM1::CC2OF)};
  if (seen.falls > 0) seen.width_us = TIM1::CCR2::read();  // clears CC2IF
  if (seen.rises > 0) seen.period_us = TIM1::CCR1::read();
  const bool ended = edges.look(seen, pulse);
  // Only of the flags that have been seen: an edge may come in here.
  TIM1::SR::write(~(sr & (TIM1::CC1OF | TIM1::CC2OF | (ended ? TIM1::UIF : 0u))));
  return ended &&
         (sr & TIM1::UIF) == 0;  // else the counter has gone round: the period is not what it says
}

}  // namespace fw::esc::pulse_input
