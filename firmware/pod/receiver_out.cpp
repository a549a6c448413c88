#include "firmware/pod/receiver_out.hpp"

#include <algorithm>
#include <bit>

#include "firmware/hal/clock.hpp"
#include "firmware/hal/interrupts.hpp"
#include "firmware/hal/registers.hpp"
#include "firmware/pod/pod_pins.hpp"
#include "firmware/pod/pod_time.hpp"

namespace fw::pod {
namespace {

using namespace hw;
namespace receiver = whirl::core::receiver;

constexpr std::uint32_t us(std::int64_t ns) {
  return static_cast<std::uint32_t>(ns / 1000);
}

// ---- SBUS

constexpr std::uint32_t kAf7 = 7, kUsart2Channel = 4;
constexpr std::uint32_t kPeriod_us = us(receiver::kSbusPeriod_ns);
constinit std::array<std::uint8_t, receiver::kSbusBytes> on_line{};

// ---- CPPM

constexpr std::uint32_t kAf2 = 2;
constexpr std::uint32_t steps(std::int64_t ns) {
  return static_cast<std::uint32_t>(ns / receiver::kCppmStep_ns);
}
constexpr std::uint32_t kStep_Hz = 1'000'000'000 / receiver::kCppmStep_ns;
constexpr std::uint32_t kPulse = steps(receiver::kCppmPulse_ns);
constexpr std::uint32_t kFrame = steps(receiver::kCppmFrame_ns);
constexpr std::uint32_t kShortestGap = steps(receiver::kCppmShortestGap_ns);
// Room for the pulse and, behind it, for an edge; and what a timer of 16 bits counts.
constexpr std::uint16_t kLeast = kPulse + 100, kMostSteps = 0xFFFF;

}  // namespace

constinit SbusOut sbus_out;
constinit CppmOut cppm_out;

void SbusOut::start() {
  RCC::AHB1ENR::set(RCC::GPIOAEN | RCC::DMA1EN);
  RCC::APB1ENR::set(RCC::USART2EN);
  SbusTx::alternate(kAf7, false, hal::Pull::none);
  USART2::BRR::write(hal::kPclk1_Hz / receiver::kSbusBaud);
  USART2::CR2::write(USART2::STOP_2);
  USART2::CR3::write(USART2::DMAT);
  USART2::CR1::write(USART2::UE | USART2::TE | USART2::M | USART2::PCE);
  Usart2TxDma::PAR::write(USART2::DR::address);
  due_us_ = us(receiver::kSbusBoot_ns);
}

void SbusOut::set(std::span<const std::uint8_t> data, std::uint32_t now_us) {
  std::copy_n(data.begin(), kData, data_.begin());
  told_ = (data_.back() & kSilent) == 0;
  told_us_ = now_us;
}

std::uint8_t SbusOut::flags(std::uint32_t now_us) const {
  const std::uint32_t silent_us = now_us - told_us_;
  std::uint8_t flags = data_.back();
  if (silent_us > us(receiver::kLost_after_ns)) flags |= receiver::kSbusFrameLost;
  if (silent_us > us(receiver::kFailsafe_after_ns)) flags |= receiver::kSbusFailsafe;
  return flags;
}

void SbusOut::poll(std::uint32_t now_us) {
  const std::uint32_t late_us = now_us - due_us_;
  if (static_cast<std::int32_t>(late_us) < 0) return;
  due_us_ = late_us < kPeriod_us ? due_us_ + kPeriod_us : now_us + kPeriod_us;
  if (!told_) return;
  on_line.front() = receiver::kSbusStart;
  std::copy(data_.begin(), data_.end(), on_line.begin() + 1);
  on_line[kData] = flags(now_us);
  on_line.back() = receiver::kSbusEnd;
  using Dma = Usart2TxDma;
  Dma::CR::write(0);
  Dma::IFCR::write(Dma::all_flags);
  Dma::M0AR::write(std::bit_cast<std::uint32_t>(on_line.data()));
  Dma::NDTR::write(on_line.size());
  __asm volatile("dsb" ::: "memory");
  Dma::CR::write(Dma::channel(kUsart2Channel) | Dma::MINC | Dma::DIR_M2P | Dma::EN);
}

// The timer begins each interval with a pulse; its length is preloaded while the one before it runs.
void CppmOut::start() {
  RCC::AHB1ENR::set(RCC::GPIOBEN);
  RCC::APB1ENR::set(RCC::TIM4EN);
  CppmPin::alternate(kAf2, false, hal::Pull::none);
  TIM4::PSC::write(hal::kTimclk1_Hz / kStep_Hz - 1);
  TIM4::ARR::write(kFrame - 1);
  TIM4::CCR1::write(0);
  TIM4::CCMR1::write(TIM4::OC1M_PWM1 | TIM4::OC1PE);
  TIM4::CCER::write(TIM4::CC1E);
  TIM4::CR1::write(TIM4::ARPE | TIM4::URS);
  TIM4::EGR::write(TIM4::UG);
  TIM4::SR::write(0);
  TIM4::DIER::write(TIM4::UIE);
  Nvic<Irq::TIM4_Global>::enable(hal::kPriorityUart);
  TIM4::CR1::set(TIM4::CEN);
}

void CppmOut::set(std::span<const std::uint16_t> steps, std::uint32_t now_us) {
  const hal::PriorityLock<hal::kPriorityUart> lock;
  told_count_ = std::min(steps.size(), kMost);
  for (std::size_t i = 0; i < told_count_; ++i) {
    told_[i] = std::clamp(steps[i], kLeast, kMostSteps);
  }
  told_us_ = now_us;
}

void CppmOut::begin_frame() {
  const bool silent = now_us() - told_us_ > us(receiver::kFailsafe_after_ns);
  count_ = silent ? 0 : told_count_;
  sent_ = told_;
  passed_ = 0;
  TIM4::CCR1::write(count_ == 0 ? 0 : kPulse);
}

// The interval after the one that has just begun.
void CppmOut::on_update() {
  if (next_ == 0) begin_frame();
  std::uint32_t interval = kFrame;
  if (next_ < count_) {
    interval = sent_[next_++];
    passed_ += interval;
  } else if (count_ != 0) {
    interval = std::max(kFrame - std::min(passed_, kFrame), kShortestGap);
    next_ = 0;
  }
  TIM4::ARR::write(interval - 1);
}

}  // namespace fw::pod

extern "C" void tim4_handler() {
  fw::hw::TIM4::SR::write(0);
  fw::pod::cppm_out.on_update();
}
