#include "firmware/hal/edge_capture.hpp"

#include "firmware/hal/clock.hpp"
#include "firmware/hal/interrupts.hpp"
#include "firmware/hal/pins.hpp"
#include "firmware/hal/registers.hpp"
#include "firmware/hal/time_base.hpp"

namespace fw::hal {
namespace {

using namespace hw;

constexpr std::uint32_t kAfTim1 = 1;
// TIM1 stays this much behind the time base: an edge never seems to lie ahead of the present.
constexpr std::uint32_t kBehind_us = 8;

}  // namespace

void start_edge_capture() {
  RCC::AHB1ENR::set(RCC::GPIOAEN);
  RCC::APB2ENR::set(RCC::TIM1EN);
  ReceiverPulses::alternate(kAfTim1, false, Pull::up);
  TIM1::PSC::write(kTimclk2_Hz / 1'000'000 - 1);
  TIM1::ARR::write(0xFFFF);
  TIM1::CR1::write(TIM1::CKD_DIV4 | TIM1::URS);
  TIM1::EGR::write(TIM1::UG);
  TIM1::CCMR2::write(TIM1::CC3S_TI3 | TIM1::IC3F_LONGEST);
  TIM1::CCER::write(TIM1::CC3E);
  TIM1::SR::write(0);
  TIM1::DIER::write(TIM1::CC3IE);
  TIM1::CNT::write((now_us() - kBehind_us) & 0xFFFF);
  TIM1::CR1::set(TIM1::CEN);
  Nvic<Irq::TIM1_CC>::enable(kPriorityUart);
}

}  // namespace fw::hal

extern "C" void tim1_cc_handler() {
  using namespace fw;
  const std::uint32_t captured = hw::TIM1::CCR3::read();  // clears CC3IF
  hw::TIM1::SR::write(~hw::TIM1::CC3OF);  // a lost edge makes an interval that is too long
  const std::uint32_t now = hal::now_us();
  receiver_edge(now - ((now - captured) & 0xFFFF));
}
