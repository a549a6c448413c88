#include "io_bridges/devices/mpu6000.hpp"

#include <algorithm>
#include <cmath>

#include "io_bridges/devices/mpu6000_registers.hpp"

namespace whirl::io {
namespace {

using namespace mpu;

constexpr double kTick_ns = 125'000.0;  // 8 kHz
constexpr double kTick_s = 125e-6;
constexpr std::int64_t kSlowRatio = 8;  // 8 kHz to 1 kHz
constexpr Nanoseconds kPulse_ns = 50'000;
constexpr std::size_t kFifoBytes = 1024;
constexpr double kG_mps2 = 9.80665;
constexpr double kDeg_per_rad = 57.29577951308232;

}  // namespace

Mpu6000::Mpu6000(EventQueue& queue, const Params& params, Sense sense, Wire* interrupt,
                 FaultBook* faults, FindingSink findings)
    : queue_(queue),
      params_(params),
      sense_(std::move(sense)),
      interrupt_(interrupt),
      faults_(faults),
      registers_(register_map(), params.name, std::move(findings)),
      sample_due_(queue, [this] { take_sample(); }),
      pulse_end_(queue, [this] { drive_interrupt(false, queue_.now()); }),
      supply_(
          queue, faults, params.bus, params.device, [this](Nanoseconds now) { supply(false, now); },
          [this](Nanoseconds now) { supply(true, now); }) {
  if (interrupt_ != nullptr) driver_ = interrupt_->add_driver(params_.name);
  reset(queue_.now());
}

// ---- Power and clock

void Mpu6000::reset(Nanoseconds now) {
  registers_.reset();
  registers_.poke(PRODUCT_ID, params_.product_id);
  ready_ns_ = now + params_.register_start_ns;
  clock_ns_ = kNever;
  sample_due_.cancel();
  pulse_end_.cancel();
  internal_.fill(0);
  pending_ = settled_ = false;
  fifo_.clear();
  drive_interrupt(false, now);
}

void Mpu6000::supply(bool on, Nanoseconds now) {
  powered_ = on;
  reset(now);
}

double Mpu6000::tick_ns() const {
  const bool internal = (registers_.peek(PWR_MGMT_1) & kCLKSEL) == 0;
  return kTick_ns * (1.0 + (internal ? params_.internal_clock_error : params_.pll_clock_error));
}

std::int64_t Mpu6000::ticks_per_sample() const {
  const bool fast = dlpf_row(registers_.peek(CONFIG)).gyro_rate_kHz == 8;
  return (fast ? 1 : kSlowRatio) * (1 + registers_.peek(SMPLRT_DIV));
}

Nanoseconds Mpu6000::time_of_tick(std::int64_t tick) const {
  return clock_ns_ + std::llround(static_cast<double>(tick) * tick_ns());
}

// Tick 0 is due at `now` and gives the first sample; without a clock there is none.
void Mpu6000::restart_clock(Nanoseconds now) {
  const std::uint8_t power = registers_.peek(PWR_MGMT_1);
  sample_due_.cancel();
  clock_ns_ = kNever;
  if ((power & kSLEEP) != 0 || (power & kCLKSEL) > 3) return;
  clock_ns_ = now;
  ticks_ = next_sample_ = 0;
  set_filters();
  sample_due_.at(time_of_tick(next_sample_));
}

void Mpu6000::set_filters() {
  const DlpfRow& row = dlpf_row(registers_.peek(CONFIG));
  for (std::size_t i = 0; i < 6; ++i) {
    if (i < 3) axes_[i].filter.emplace(row.accel_Hz, row.accel_delay_s, kTick_s);
    if (i >= 3) axes_[i].filter.emplace(row.gyro_Hz, row.gyro_delay_s, kTick_s);
  }
  settled_ = false;
}

// ---- Sampling

// The part's analogue side and its filters, up to and with that tick.
void Mpu6000::run_ticks(std::int64_t until) {
  const bool gyro_fast = dlpf_row(registers_.peek(CONFIG)).gyro_rate_kHz == 8;
  for (; ticks_ <= until; ++ticks_) {
    const Truth truth = sense_(time_of_tick(ticks_));
    temperature_K_ = truth.temperature_K;
    for (std::size_t i = 0; i < 6; ++i) {
      Axis& axis = axes_[i];
      const double input = i < 3 ? truth.specific_force_mps2[i] : truth.rate_radps[i - 3];
      if (!settled_) axis.filter->settle(input);
      axis.filter->step(input);
      const bool every_tick = i >= 3 && gyro_fast;
      if (every_tick || ticks_ % kSlowRatio == 0) axis.latched = axis.filter->output();
    }
    settled_ = true;
  }
}

void Mpu6000::take_sample() {
  const Nanoseconds now = queue_.now();
  run_ticks(next_sample_);
  next_sample_ += ticks_per_sample();
  sample_due_.at(time_of_tick(next_sample_));
  sample_ns_ = now;
  ++samples_;
  encode_sample(now);
  fill_fifo();
  raise_interrupt(kDATA_RDY);
}

double Mpu6000::faulted(int axis, double value, Nanoseconds now) {
  if (const Fault* offset = fault(FaultKind::sensor_offset, now, axis)) value += offset->value;
  return fault(FaultKind::sensor_saturated, now, axis) != nullptr ? 1e9 : value;
}

void Mpu6000::store(std::uint8_t address, long counts) {
  const long clipped = std::clamp(counts, -32768L, 32767L);
  const std::size_t at = address - ACCEL_XOUT_H;
  internal_[at] = static_cast<std::uint8_t>(clipped >> 8 & 0xFF);
  internal_[at + 1] = static_cast<std::uint8_t>(clipped & 0xFF);
}

void Mpu6000::encode_sample(Nanoseconds now) {
  if (fault(FaultKind::sensor_frozen, now) != nullptr) return;
  const double per_mps2 = kAccel_counts_per_g[registers_.peek(ACCEL_CONFIG) >> 3 & 3] / kG_mps2;
  const double per_radps =
      kGyro_counts_per_degps[registers_.peek(GYRO_CONFIG) >> 3 & 3] * kDeg_per_rad;
  for (int i = 0; i < 6; ++i) {
    const double scale = i < 3 ? per_mps2 : per_radps;
    const double value = faulted(i, axes_[static_cast<std::size_t>(i)].latched, now);
    const int first = i < 3 ? ACCEL_XOUT_H : GYRO_XOUT_H - 6;
    store(static_cast<std::uint8_t>(first + 2 * i), std::lround(value * scale));
  }
  store(TEMP_OUT_H, std::lround((temperature_K_ - 273.15 - 36.53) * 340.0));
  pending_ = true;
  if (!busy_) end_access();
}

// The registers follow the sensors only while the bus is idle: one burst, one instant (RM 4.18).
void Mpu6000::end_access() {
  busy_ = false;
  if (!pending_) return;
  pending_ = false;
  for (std::size_t i = 0; i < internal_.size(); ++i) {
    registers_.poke(static_cast<std::uint8_t>(ACCEL_XOUT_H + i), internal_[i]);
  }
}

// ---- FIFO and interrupt

void Mpu6000::fill_fifo() {
  if ((registers_.peek(USER_CTRL) & kFIFO_ENABLE) == 0) return;
  const std::uint8_t enabled = registers_.peek(FIFO_EN);
  for (std::size_t i = 0; i < internal_.size(); ++i) {  // in register order, low to high
    const std::uint8_t gate = i < 6    ? kACCEL_FIFO_EN
                              : i < 8  ? kTEMP_FIFO_EN
                              : i < 10 ? kXG_FIFO_EN
                              : i < 12 ? kYG_FIFO_EN
                                       : kZG_FIFO_EN;
    if ((enabled & gate) != 0) push_fifo(internal_[i]);
  }
}

void Mpu6000::push_fifo(std::uint8_t byte) {
  if (fifo_.size() == kFifoBytes) {
    fifo_.pop_front();
    raise_interrupt(kFIFO_OFLOW);
  }
  fifo_.push_back(byte);
}

std::uint8_t Mpu6000::pop_fifo() {
  if (fifo_.empty()) return fifo_last_;
  fifo_last_ = fifo_.front();
  fifo_.pop_front();
  return fifo_last_;
}

void Mpu6000::raise_interrupt(std::uint8_t status_bit) {
  registers_.poke(INT_STATUS, registers_.peek(INT_STATUS) | status_bit);
  if ((registers_.peek(INT_ENABLE) & status_bit) == 0) return;
  drive_interrupt(true, queue_.now());
  if ((registers_.peek(INT_PIN_CFG) & kLATCH_INT_EN) == 0) pulse_end_.in(kPulse_ns);
}

void Mpu6000::clear_interrupt(Nanoseconds now) {
  registers_.poke(INT_STATUS, 0);
  if ((registers_.peek(INT_PIN_CFG) & kLATCH_INT_EN) != 0) drive_interrupt(false, now);
}

void Mpu6000::drive_interrupt(bool active, Nanoseconds now) {
  if (interrupt_ == nullptr) return;
  const std::uint8_t pin = registers_.peek(INT_PIN_CFG);
  const bool high = active != ((pin & kINT_LEVEL) != 0);
  const Drive up = (pin & kINT_OPEN) != 0 ? Drive::none : Drive::high;
  interrupt_->drive(driver_, high ? up : Drive::low, now);
}

}  // namespace whirl::io
