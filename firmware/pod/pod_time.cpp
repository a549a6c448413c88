#include "firmware/pod/pod_time.hpp"

#include "firmware/hal/clock.hpp"
#include "firmware/hal/interrupts.hpp"
#include "firmware/hal/registers.hpp"
#include "firmware/pod/pod_pins.hpp"

namespace fw::pod {
namespace {

using namespace hw;

constexpr std::uint32_t kMicrosecond = hal::kTimclk1_Hz / 1'000'000 - 1;
constinit std::uint32_t last_us = 0, wraps = 0;

template <typename Timer>
void load(std::uint32_t reload) {
  Timer::PSC::write(kMicrosecond);
  Timer::ARR::write(reload);
  Timer::CR1::write(Timer::URS);  // the update below loads the prescaler and shall raise nothing
  Timer::EGR::write(Timer::UG);
  Timer::SR::write(0);
}

// An update after so long, once.
template <typename Timer>
void begin(std::uint32_t us) {
  Timer::CR1::clear(Timer::CEN);
  Timer::SR::write(0);
  if (us == 0) return;
  Timer::ARR::write(us);
  Timer::CNT::write(0);
  Timer::CR1::set(Timer::OPM | Timer::CEN);
}

}  // namespace

void start_time() {
  RCC::APB1ENR::set(RCC::TIM2EN | RCC::TIM5EN | RCC::TIM7EN);
  load<TIM2>(0xFFFF'FFFF);
  TIM2::CR1::set(TIM2::CEN);
  load<TIM5>(0xFFFF'FFFF);
  load<TIM7>(0xFFFF);
  TIM5::DIER::write(TIM5::UIE);
  TIM7::DIER::write(TIM7::UIE);
  Nvic<Irq::TIM5_Global>::enable(kPriorityParts);
  Nvic<Irq::TIM7_Global>::enable(kPriorityParts);
}

std::uint32_t now_us() {
  return TIM2::CNT::read();
}

std::int64_t now_ns() {
  const hal::PriorityLock<kPriorityParts> lock;
  const std::uint32_t us = now_us();
  if (us < last_us) ++wraps;
  last_us = us;
  return static_cast<std::int64_t>((static_cast<std::uint64_t>(wraps) << 32 | us) * 1000);
}

void pulse_timer(std::uint32_t us) {
  begin<TIM7>(us);
}

void alarm_timer(std::uint32_t us) {
  begin<TIM5>(us);
}

}  // namespace fw::pod

extern "C" void tim5_handler() {
  fw::hw::TIM5::SR::write(0);
  fw::pod::alarm();
}
extern "C" void tim7_handler() {
  fw::hw::TIM7::SR::write(0);
  fw::pod::pulse_over();
}
