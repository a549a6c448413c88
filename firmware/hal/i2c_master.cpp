#include "firmware/hal/i2c_master.hpp"

#include <algorithm>
#include <bit>

#include "firmware/hal/clock.hpp"
#include "firmware/hal/interrupts.hpp"
#include "firmware/hal/pins.hpp"
#include "firmware/hal/registers.hpp"

namespace fw::hal {

using namespace hw;

constinit I2cMaster i2c3;

namespace {

constexpr std::uint32_t kAfI2c3 = 4, kDmaChannel = 3;
constexpr std::uint32_t kPclk1_MHz = kPclk1_Hz / 1'000'000;
constexpr std::uint32_t kFast_400kHz = kPclk1_Hz / (3 * 400'000);  // low is twice as long as high
constexpr std::uint32_t kRise_300ns = kPclk1_MHz * 300 / 1000 + 1;
constexpr std::uint32_t kTimeout_us = 600;  // the longest transaction takes 190 us
constexpr std::uint32_t kGap_us = 12;       // STOP, and bus free time 1.3 us
constexpr std::uint32_t kHalfClock_us = 5;  // 100 kHz while recovering
constexpr std::uint8_t kRecoveryClocks = 9;

void arm_timer(std::uint32_t delay_us) {
  TIM7::CR1::write(TIM7::URS);
  TIM7::CNT::write(0);
  TIM7::ARR::write(delay_us - 1);
  TIM7::SR::write(0);
  TIM7::CR1::write(TIM7::URS | TIM7::OPM | TIM7::CEN);
}

void stop_timer() {
  TIM7::CR1::write(TIM7::URS);
  TIM7::SR::write(0);
}

void give_pins_to_block() {
  I2cScl::alternate(kAfI2c3, true, Pull::up);
  I2cSda::alternate(kAfI2c3, true, Pull::up);
}

void receive_by_dma(std::span<const std::uint8_t> buffer, std::uint32_t length) {
  I2c3RxDma::IFCR::write(I2c3RxDma::all_flags);
  I2c3RxDma::PAR::write(I2C3::DR::address);
  I2c3RxDma::M0AR::write(std::bit_cast<std::uint32_t>(buffer.data()));
  I2c3RxDma::NDTR::write(length);
  I2c3RxDma::CR::write(I2c3RxDma::channel(kDmaChannel) | I2c3RxDma::priority(1) | I2c3RxDma::MINC |
                       I2c3RxDma::TCIE | I2c3RxDma::EN);
  I2C3::CR2::write(kPclk1_MHz | I2C3::ITEVTEN | I2C3::ITERREN | I2C3::DMAEN | I2C3::LAST);
}

}  // namespace

void I2cMaster::init() {
  RCC::AHB1ENR::set(RCC::GPIOAEN | RCC::GPIOCEN | RCC::DMA1EN);
  RCC::APB1ENR::set(RCC::I2C3EN | RCC::TIM7EN);
  TIM7::PSC::write(kTimclk1_Hz / 1'000'000 - 1);
  TIM7::CR1::write(TIM7::URS);
  TIM7::EGR::write(TIM7::UG);
  TIM7::SR::write(0);
  TIM7::DIER::write(TIM7::UIE);
  give_pins_to_block();
  configure();
  Nvic<Irq::TIM7_Global>::enable(kPriorityI2c);
  Nvic<Irq::I2C3_EV>::enable(kPriorityI2c);
  Nvic<Irq::I2C3_ER>::enable(kPriorityI2c);
  Nvic<Irq::DMA1_Stream2>::enable(kPriorityI2c);
}

void I2cMaster::configure() {
  I2C3::CR1::write(I2C3::SWRST);
  I2C3::CR1::write(0);
  I2C3::CR2::write(kPclk1_MHz);
  I2C3::CCR::write(I2C3::FS | kFast_400kHz);
  I2C3::TRISE::write(kRise_300ns);
  I2C3::CR1::write(I2C3::PE);
}

Status I2cMaster::submit(const I2cJob& job) {
  const InterruptLock lock;
  if (count_ == kQueue) return Status::busy;
  queue_[(head_ + count_++) % kQueue] = job;
  if (state_ == State::idle) start_next();
  return Status::ok;
}

void I2cMaster::start_next() {
  if (count_ == 0) {
    state_ = State::idle;
    return;
  }
  if (I2C3::SR2::has(I2C3::BUSY) || I2C3::CR1::has(I2C3::STOP)) {
    ++counters_.bus_errors;
    return recover();
  }
  state_ = State::running;
  sent_ = 0;
  I2C3::SR1::write(0);
  I2C3::CR2::write(kPclk1_MHz | I2C3::ITEVTEN | I2C3::ITERREN);
  I2C3::CR1::write(I2C3::PE | I2C3::ACK | I2C3::START);
  arm_timer(kTimeout_us);
}

void I2cMaster::on_event() {
  if (state_ != State::running) return I2C3::CR2::write(kPclk1_MHz);
  const I2cJob& job = queue_[head_];
  const std::uint32_t flags = I2C3::SR1::read();
  if ((flags & I2C3::SB) != 0) {
    I2C3::DR::write(static_cast<std::uint32_t>(job.address) << 1 | (job.read ? 1u : 0u));
  } else if ((flags & I2C3::ADDR) != 0) {
    begin_data();
  } else if (!job.read && sent_ == job.length && (flags & I2C3::BTF) != 0) {
    I2C3::CR2::write(kPclk1_MHz);  // BTF stays up until the STOP is out
    I2C3::CR1::set(I2C3::STOP);
    finish(Status::ok);
  } else if (!job.read && sent_ < job.length && (flags & I2C3::TXE) != 0) {
    I2C3::DR::write(job.bytes[sent_++]);
    if (sent_ == job.length) I2C3::CR2::clear(I2C3::ITBUFEN);
  }
}

// The address was acknowledged. Reading SR2 lets the bus go on, so what follows is set up before.
void I2cMaster::begin_data() {
  const I2cJob& job = queue_[head_];
  if (job.read) {
    receive_by_dma(received_, job.length);
  } else {
    I2C3::CR2::set(I2C3::ITBUFEN);
  }
  static_cast<void>(I2C3::SR2::read());
}

void I2cMaster::on_received() {
  I2c3RxDma::IFCR::write(I2c3RxDma::all_flags);
  if (state_ != State::running) return;
  I2C3::CR2::write(kPclk1_MHz);
  I2C3::CR1::set(I2C3::STOP);
  std::copy(received_.begin(), received_.end(), queue_[head_].bytes.begin());
  finish(Status::ok);
}

void I2cMaster::on_error() {
  const std::uint32_t flags = I2C3::SR1::read();
  I2C3::SR1::write(0);
  I2C3::CR2::write(kPclk1_MHz);
  if (state_ != State::running) return;
  if ((flags & (I2C3::BERR | I2C3::ARLO)) != 0) {
    ++counters_.bus_errors;
    return recover();
  }
  ++counters_.not_acknowledged;
  I2C3::CR1::set(I2C3::STOP);
  retry_or_finish(Status::no_answer);
}

void I2cMaster::retry_or_finish(Status status) {
  I2cJob& job = queue_[head_];
  if (job.retries == 0) return finish(status);
  --job.retries;
  state_ = State::gap;
  arm_timer(kGap_us);
}

void I2cMaster::finish(Status status) {
  const I2cJob done = queue_[head_];
  head_ = (head_ + 1) % kQueue;
  --count_;
  state_ = State::gap;
  arm_timer(kGap_us);
  i2c_job_done(done, status);
}

void I2cMaster::on_timer() {
  stop_timer();
  switch (state_) {
    case State::idle:
      return;
    case State::gap:
      return start_next();
    case State::running:
      ++counters_.timeouts;
      return recover();
    case State::recovering:
      return recovery_step();
  }
}

// Steps: SCL low and high by turns, at most nine clocks, until SDA is let go; then a STOP.
void I2cMaster::recover() {
  ++counters_.recoveries;
  state_ = State::recovering;
  step_ = 0;
  I2C3::CR2::write(kPclk1_MHz);
  I2C3::CR1::write(0);
  I2c3RxDma::CR::write(0);
  I2cScl::output(true, true);
  I2cSda::output(true, true);
  arm_timer(kHalfClock_us);
}

void I2cMaster::recovery_step() {
  constexpr std::uint8_t kStopFrom = 2 * kRecoveryClocks;
  arm_timer(kHalfClock_us);
  if (step_ < kStopFrom && step_ % 2 == 0 && I2cSda::level()) step_ = kStopFrom;
  switch (step_) {
    case kStopFrom:
      I2cScl::set(false);
      break;
    case kStopFrom + 1:
      I2cSda::set(false);
      break;
    case kStopFrom + 2:
      I2cScl::set(true);
      break;
    case kStopFrom + 3:
      I2cSda::set(true);
      break;
    case kStopFrom + 4:
      return leave_recovery();
    default:
      I2cScl::set(step_ % 2 != 0);
  }
  ++step_;
}

void I2cMaster::leave_recovery() {
  give_pins_to_block();
  configure();
  retry_or_finish(Status::no_answer);
}

}  // namespace fw::hal

extern "C" void i2c3_ev_handler() {
  fw::hal::i2c3.on_event();
}
extern "C" void i2c3_er_handler() {
  fw::hal::i2c3.on_error();
}
extern "C" void dma1_stream2_handler() {
  fw::hal::i2c3.on_received();
}
extern "C" void tim7_handler() {
  fw::hal::i2c3.on_timer();
}
