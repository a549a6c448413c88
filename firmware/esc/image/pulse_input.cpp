#include "firmware/esc/image/pulse_input.hpp"

#include "firmware/esc/image/registers.hpp"

namespace fw::esc::pulse_input {

using namespace f103;

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
  if ((sr & TIM1::CC1IF) == 0) return false;
  pulse.width_us = TIM1::CCR2::read();
  pulse.period_us = TIM1::CCR1::read();  // clears CC1IF
  TIM1::SR::write(~(TIM1::UIF | TIM1::CC1OF));
  if ((sr & TIM1::CC1OF) != 0) pulse.period_us = 0;
  return (sr & TIM1::UIF) == 0;  // else the counter has gone round: the period is not what it says
}

}  // namespace fw::esc::pulse_input
