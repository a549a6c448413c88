#include "firmware/hal/i2c_master.hpp"

#include <algorithm>
#include <bit>

#include "firmware/hal/clock.hpp"
#include "firmware/hal/interrupts.hpp"
#include "firmware/hal/pins.hpp"
#include "firmware/hal/registers.hpp"

namespace fw::hal {

using namespace hw;

struct EscI2c {
  using Block = I2C3;
  using Dma = I2c3RxDma;
  using Timer = TIM7;
  using Scl = EscScl;
  using Sda = EscSda;
  static constexpr std::uint32_t kDmaChannel = 3;
  static constexpr Irq kEvent = Irq::I2C3_EV, kError = Irq::I2C3_ER, kReceived = Irq::DMA1_Stream2,
                       kTimer = Irq::TIM7_Global;
  static void start_clocks() {
    RCC::AHB1ENR::set(RCC::GPIOAEN | RCC::GPIOCEN | RCC::DMA1EN);
    RCC::APB1ENR::set(RCC::I2C3EN | RCC::TIM7EN);
  }
  static void done(const I2cJob& job, Status status) { esc_job_done(job, status); }
};

struct SensorI2c {
  using Block = I2C2;
  using Dma = I2c2RxDma;
  using Timer = TIM6;
  using Scl = SensorScl;
  using Sda = SensorSda;
  static constexpr std::uint32_t kDmaChannel = 7;
  static constexpr Irq kEvent = Irq::I2C2_EV, kError = Irq::I2C2_ER, kReceived = Irq::DMA1_Stream3,
                       kTimer = Irq::TIM6_DAC;
  static void start_clocks() {
    RCC::AHB1ENR::set(RCC::GPIOBEN | RCC::DMA1EN);
    RCC::APB1ENR::set(RCC::I2C2EN | RCC::TIM6EN);
  }
  static void done(const I2cJob& job, Status status) { sensor_job_done(job, status); }
};

constinit I2cMaster<EscI2c> i2c3;
constinit I2cMaster<SensorI2c> i2c2;

namespace {

constexpr std::uint32_t kAfI2c = 4;
constexpr std::uint32_t kPclk1_MHz = kPclk1_Hz / 1'000'000;
constexpr std::uint32_t kFast_400kHz = kPclk1_Hz / (3 * 400'000);  // low is twice as long as high
constexpr std::uint32_t kRise_300ns = kPclk1_MHz * 300 / 1000 + 1;
constexpr std::uint32_t kTimeout_us = 600;  // the longest transaction takes 190 us
constexpr std::uint32_t kGap_us = 12;       // STOP, and bus free time 1.3 us
constexpr std::uint32_t kHalfClock_us = 5;  // 100 kHz while recovering
constexpr std::uint8_t kRecoveryClocks = 9;

// Of a timer that has run out: by OPM it has then stopped at 0. (One that still runs its gap goes on
// from there, which ends the delay early by less than the gap.)
template <typename T>
void start_timer(std::uint32_t delay_us) {
  T::ARR::write(delay_us - 1);
  T::CR1::write(T::URS | T::OPM | T::CEN);
}

// Of one that may still run.
template <typename T>
void restart_timer(std::uint32_t delay_us) {
  T::CR1::write(T::URS);
  T::CNT::write(0);
  T::SR::write(0);
  start_timer<T>(delay_us);
}

template <typename Bus>
void give_pins_to_block() {
  Bus::Scl::alternate(kAfI2c, true, Pull::up);
  Bus::Sda::alternate(kAfI2c, true, Pull::up);
}

template <typename I2C>
constexpr std::uint32_t kEvents = kPclk1_MHz | I2C::ITEVTEN | I2C::ITERREN;

template <typename Bus>
void receive_by_dma(std::uint32_t length) {
  using Dma = typename Bus::Dma;
  using I2C = typename Bus::Block;
  Dma::IFCR::write(Dma::all_flags);
  Dma::NDTR::write(length);
  Dma::CR::write(Dma::channel(Bus::kDmaChannel) | Dma::priority(1) | Dma::MINC | Dma::TCIE |
                 Dma::EN);
  I2C::CR2::write(kEvents<I2C> | I2C::DMAEN | I2C::LAST);
}

// ACK as it was; PE and it are all else that is up then.
template <typename I2C>
void stop_bus() {
  I2C::CR1::write(I2C::PE | I2C::ACK | I2C::STOP);
}

}  // namespace

template <typename Bus>
void I2cMaster<Bus>::init() {
  using Timer = typename Bus::Timer;
  Bus::start_clocks();
  Timer::PSC::write(kTimclk1_Hz / 1'000'000 - 1);
  Timer::CR1::write(Timer::URS);
  Timer::EGR::write(Timer::UG);
  Timer::SR::write(0);
  Timer::DIER::write(Timer::UIE);
  Bus::Dma::PAR::write(Bus::Block::DR::address);
  Bus::Dma::M0AR::write(std::bit_cast<std::uint32_t>(received_.data()));
  give_pins_to_block<Bus>();
  configure();
  Nvic<Bus::kTimer>::enable(kPriorityI2c);
  Nvic<Bus::kEvent>::enable(kPriorityI2c);
  Nvic<Bus::kError>::enable(kPriorityI2c);
  Nvic<Bus::kReceived>::enable(kPriorityI2c);
}

template <typename Bus>
void I2cMaster<Bus>::configure() {
  using I2C = typename Bus::Block;
  I2C::CR1::write(I2C::SWRST);
  I2C::CR1::write(0);
  I2C::CR2::write(kPclk1_MHz);
  I2C::CCR::write(I2C::FS | kFast_400kHz);
  I2C::TRISE::write(kRise_300ns);
  I2C::CR1::write(I2C::PE);
}

template <typename Bus>
Status I2cMaster<Bus>::submit(const I2cJob& job) {
  const InterruptLock lock;
  if (count_ == kQueue) return Status::busy;
  queue_[(head_ + count_++) % kQueue] = job;
  if (state_ == State::idle) start_next();
  return Status::ok;
}

template <typename Bus>
void I2cMaster<Bus>::start_next() {
  using I2C = typename Bus::Block;
  if (count_ == 0) {
    state_ = State::idle;
    return;
  }
  if (I2C::SR2::has(I2C::BUSY) || I2C::CR1::has(I2C::STOP)) {
    ++counters_.bus_errors;
    return recover();
  }
  state_ = State::running;
  sent_ = 0;
  I2C::SR1::write(0);
  I2C::CR2::write(kEvents<I2C>);
  I2C::CR1::write(I2C::PE | I2C::ACK | I2C::START);
  start_timer<typename Bus::Timer>(kTimeout_us);
}

template <typename Bus>
void I2cMaster<Bus>::on_event() {
  using I2C = typename Bus::Block;
  if (state_ != State::running) return I2C::CR2::write(kPclk1_MHz);
  const I2cJob& job = queue_[head_];
  const std::uint32_t flags = I2C::SR1::read();
  if ((flags & I2C::SB) != 0) {
    I2C::DR::write(static_cast<std::uint32_t>(job.address) << 1 | (job.read ? 1u : 0u));
  } else if ((flags & I2C::ADDR) != 0) {
    begin_data();
  } else if (!job.read && sent_ == job.length && (flags & I2C::BTF) != 0) {
    I2C::CR2::write(kPclk1_MHz);  // BTF stays up until the STOP is out
    stop_bus<I2C>();
    finish(Status::ok);
  } else if (!job.read && sent_ < job.length && (flags & I2C::TXE) != 0) {
    I2C::DR::write(job.bytes[sent_++]);
    if (sent_ == job.length) I2C::CR2::write(kEvents<I2C>);
  }
}

// The address was acknowledged. Reading SR2 lets the bus go on, so what follows is set up before.
template <typename Bus>
void I2cMaster<Bus>::begin_data() {
  using I2C = typename Bus::Block;
  const I2cJob& job = queue_[head_];
  if (job.read) {
    receive_by_dma<Bus>(job.length);
  } else {
    I2C::CR2::write(kEvents<I2C> | I2C::ITBUFEN);
  }
  static_cast<void>(I2C::SR2::read());
}

template <typename Bus>
void I2cMaster<Bus>::on_received() {
  using I2C = typename Bus::Block;
  using Dma = typename Bus::Dma;
  Dma::IFCR::write(Dma::all_flags);
  if (state_ != State::running) return;
  I2C::CR2::write(kPclk1_MHz);
  stop_bus<I2C>();
  std::copy(received_.begin(), received_.end(), queue_[head_].bytes.begin());
  finish(Status::ok);
}

template <typename Bus>
void I2cMaster<Bus>::on_error() {
  using I2C = typename Bus::Block;
  const std::uint32_t flags = I2C::SR1::read();
  I2C::SR1::write(0);
  I2C::CR2::write(kPclk1_MHz);
  if (state_ != State::running) return;
  if ((flags & (I2C::BERR | I2C::ARLO)) != 0) {
    ++counters_.bus_errors;
    return recover();
  }
  ++counters_.not_acknowledged;
  stop_bus<I2C>();
  retry_or_finish(Status::no_answer);
}

template <typename Bus>
void I2cMaster<Bus>::retry_or_finish(Status status) {
  I2cJob& job = queue_[head_];
  if (job.retries == 0) return finish(status);
  --job.retries;
  state_ = State::gap;
  restart_timer<typename Bus::Timer>(kGap_us);
}

template <typename Bus>
void I2cMaster<Bus>::finish(Status status) {
  const I2cJob done = queue_[head_];
  head_ = (head_ + 1) % kQueue;
  --count_;
  state_ = State::gap;
  restart_timer<typename Bus::Timer>(kGap_us);
  Bus::done(done, status);
}

template <typename Bus>
void I2cMaster<Bus>::on_timer() {
  Bus::Timer::SR::write(0);
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
template <typename Bus>
void I2cMaster<Bus>::recover() {
  using I2C = typename Bus::Block;
  using Dma = typename Bus::Dma;
  ++counters_.recoveries;
  state_ = State::recovering;
  step_ = 0;
  I2C::CR2::write(kPclk1_MHz);
  I2C::CR1::write(0);
  Dma::CR::write(0);
  Bus::Scl::output(true, true);
  Bus::Sda::output(true, true);
  restart_timer<typename Bus::Timer>(kHalfClock_us);
}

template <typename Bus>
void I2cMaster<Bus>::recovery_step() {
  constexpr std::uint8_t kStopFrom = 2 * kRecoveryClocks;
  restart_timer<typename Bus::Timer>(kHalfClock_us);
  if (step_ < kStopFrom && step_ % 2 == 0 && Bus::Sda::level()) step_ = kStopFrom;
  switch (step_) {
    case kStopFrom:
      Bus::Scl::set(false);
      break;
    case kStopFrom + 1:
      Bus::Sda::set(false);
      break;
    case kStopFrom + 2:
      Bus::Scl::set(true);
      break;
    case kStopFrom + 3:
      Bus::Sda::set(true);
      break;
    case kStopFrom + 4:
      return leave_recovery();
    default:
      Bus::Scl::set(step_ % 2 != 0);
  }
  ++step_;
}

template <typename Bus>
void I2cMaster<Bus>::leave_recovery() {
  give_pins_to_block<Bus>();
  configure();
  retry_or_finish(Status::no_answer);
}

template class I2cMaster<EscI2c>;
template class I2cMaster<SensorI2c>;

}  // namespace fw::hal

extern "C" void i2c2_ev_handler() {
  fw::hal::i2c2.on_event();
}
extern "C" void i2c2_er_handler() {
  fw::hal::i2c2.on_error();
}
extern "C" void dma1_stream3_handler() {
  fw::hal::i2c2.on_received();
}
extern "C" void tim6_dac_handler() {
  fw::hal::i2c2.on_timer();
}
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
