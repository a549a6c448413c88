#include "io_bridges/devices/mpu6000.hpp"

#include <algorithm>
#include <cmath>

#include "io_bridges/devices/mpu6000_filters.hpp"
#include "io_bridges/devices/oddity_text.hpp"

namespace whirl::io {
namespace {

using namespace mpu;

constexpr double kTick_ns = 125'000.0;  // 8 kHz
constexpr double kTick_s = 125e-6;
constexpr std::int64_t kSlowRatio = 8;  // 8 kHz to 1 kHz
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
      findings_(std::move(findings)),
      part_({params.product_id, params.i2c_address, params.register_start_ns, params.gyro_start_ns},
            *this),
      sample_due_(queue, [this] { take_sample(); }),
      pulse_end_(queue, [this] { part_.pulse_over(queue_.now()); }),
      supply_(
          queue, faults, params.bus, params.device, [this](Nanoseconds now) { supply(false, now); },
          [this](Nanoseconds now) { supply(true, now); }) {
  if (interrupt_ != nullptr) driver_ = interrupt_->add_driver(params_.name);
  part_.reset(queue_.now());
}

// ---- What the registers ask for

void Mpu6000::odd(core::Oddity what, std::uint32_t detail, Nanoseconds now) {
  findings_.report({now, params_.name, oddity_text(what, detail, &core::mpu::kMap)});
}

void Mpu6000::interrupt_pin(core::Mpu6000::Pin pin, Nanoseconds now) {
  if (interrupt_ == nullptr) return;
  const bool open = pin == core::Mpu6000::Pin::open;
  const bool high = pin == core::Mpu6000::Pin::high;
  interrupt_->drive(driver_, open ? Drive::none : high ? Drive::high : Drive::low, now);
}

std::uint8_t Mpu6000::identity(std::uint8_t who_am_i, Nanoseconds now) {
  const Fault* wrong = fault(FaultKind::sensor_wrong_identity, now);
  return wrong == nullptr ? who_am_i : static_cast<std::uint8_t>(wrong->value);
}

void Mpu6000::was_reset() {
  clock_ns_ = kNever;
  sample_due_.cancel();
  pulse_end_.cancel();
  settled_ = false;
}

void Mpu6000::supply(bool on, Nanoseconds now) {
  part_.set_powered(on);
  part_.reset(now);
}

// ---- Clock

double Mpu6000::tick_ns() const {
  const double error =
      part_.internal_clock() ? params_.internal_clock_error : params_.pll_clock_error;
  return kTick_ns * (1.0 + error);
}

Nanoseconds Mpu6000::time_of_tick(std::int64_t tick) const {
  return clock_ns_ + std::llround(static_cast<double>(tick) * tick_ns());
}

void Mpu6000::clock_restarts(Nanoseconds at) {
  sample_due_.cancel();
  clock_ns_ = at;
  if (at == kNever) return;
  ticks_ = next_sample_ = 0;
  filters_changed();
  sample_due_.at(time_of_tick(next_sample_));
}

void Mpu6000::sample_rate_changed() {
  const std::int64_t per_sample = part_.ticks_per_sample();
  const std::int64_t whole = (ticks_ + per_sample + 7) / 8 * 8;
  next_sample_ = per_sample % 8 == 0 ? whole : ticks_ + per_sample;
  sample_due_.at(time_of_tick(next_sample_));
}

void Mpu6000::filters_changed() {
  const DlpfRow& row = kDlpf[part_.dlpf()];
  for (std::size_t i = 0; i < 6; ++i) {
    if (i < 3) axes_[i].filter.emplace(row.accel_Hz, row.accel_delay_s, kTick_s);
    if (i >= 3) axes_[i].filter.emplace(row.gyro_Hz, row.gyro_delay_s, kTick_s);
  }
  settled_ = false;
}

// ---- Sampling

// The part's analogue side and its filters, up to and with that tick.
void Mpu6000::run_ticks(std::int64_t until) {
  const bool gyro_fast = part_.gyro_fast();
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
  next_sample_ += part_.ticks_per_sample();
  sample_due_.at(time_of_tick(next_sample_));
  sample_ns_ = now;
  ++samples_;
  encode_sample(now);
  part_.data_ready(now);
}

double Mpu6000::faulted(int axis, double value, Nanoseconds now) {
  if (const Fault* scale = fault(FaultKind::sensor_scale, now, axis)) value *= 1.0 + scale->value;
  value += added_by_faults(faults_, params_.bus, params_.device, now, axis);
  return fault(FaultKind::sensor_saturated, now, axis) != nullptr ? 1e9 : value;
}

void Mpu6000::encode_sample(Nanoseconds now) {
  if (fault(FaultKind::sensor_frozen, now) != nullptr) return;
  const double per_mps2 = kAccel_counts_per_g[part_.accel_range()] / kG_mps2;
  const double per_radps = kGyro_counts_per_degps[part_.gyro_range()] * kDeg_per_rad;
  const auto clipped = [](double value) {
    return static_cast<std::int16_t>(std::clamp(std::lround(value), -32768L, 32767L));
  };
  std::array<std::int16_t, 7> counts{};  // temperature between accelerometer and gyro
  for (std::size_t i = 0; i < 6; ++i) {
    const double value = faulted(static_cast<int>(i), axes_[i].latched, now);
    counts[i < 3 ? i : i + 1] = clipped(value * (i < 3 ? per_mps2 : per_radps));
  }
  counts[3] = clipped((temperature_K_ - 273.15 - 36.53) * 340.0);
  part_.store(counts);
}

}  // namespace whirl::io
