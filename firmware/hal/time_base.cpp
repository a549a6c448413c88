#include "firmware/hal/time_base.hpp"

#include "firmware/hal/clock.hpp"
#include "firmware/hal/interrupts.hpp"
#include "firmware/hal/registers.hpp"

namespace fw::hal {
namespace {

using namespace hw;

constexpr std::uint32_t kMicrosecond = kTimclk1_Hz / 1'000'000 - 1;
constexpr std::uint32_t kGuard_us = 1500, kFallbackPeriod_us = 1000;

template <typename T>
void start_counter(std::uint32_t reload) {
  T::PSC::write(kMicrosecond);
  T::ARR::write(reload);
  T::CR1::write(T::URS);  // the update below loads the prescaler and shall raise nothing
  T::EGR::write(T::UG);
  T::SR::write(0);
  T::CR1::set(T::CEN);
}

}  // namespace

void start_time_base() {
  RCC::APB1ENR::set(RCC::TIM2EN | RCC::TIM5EN);
  start_counter<TIM2>(0xFFFF'FFFF);
  start_counter<TIM5>(kGuard_us - 1);
  TIM5::DIER::write(TIM5::UIE);
  Nvic<Irq::TIM5_Global>::enable(kPriorityTick);
}

std::uint32_t now_us() {
  return TIM2::CNT::read();
}

void restart_tick_guard() {
  TIM5::CNT::write(0);
}

}  // namespace fw::hal

extern "C" void tim5_handler() {
  using namespace fw;
  hw::TIM5::SR::write(0);
  hw::TIM5::CNT::write(hal::kGuard_us - hal::kFallbackPeriod_us);
  fallback_tick();
}
