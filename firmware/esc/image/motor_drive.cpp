#include "firmware/esc/image/motor_drive.hpp"

#include "firmware/esc/image/bridge.hpp"
#include "firmware/hal/interrupts.hpp"

namespace fw::esc {
namespace {

constexpr std::uint16_t kAlign_ms = 150;
constexpr float kTrip_A = 24.0f;  // of the bus, averaged by the amplifier
constexpr int kTrip_counts = static_cast<int>(kTrip_A / sampling::kAmperes_per_count);
constexpr std::uint8_t kTripSamples = 3;

}  // namespace

void MotorDrive::go_off() {
  bridge::off();
  commutation_.stop();
  phase_ = Phase::off;
  align_ms_ = 0;
  over_ = 0;
}

void MotorDrive::on_sample(const sampling::Sample& sample) {
  shunt_sum_ += static_cast<std::uint32_t>(sample.shunt);
  bus_sum_ += static_cast<std::uint32_t>(sample.bus);
  ++samples_;
  if (phase_ == Phase::off) {
    zero_counts_ += (64 * sample.shunt - zero_counts_) / 64;
    return;
  }
  const bool over = sample.shunt - zero_counts_ / 64 > kTrip_counts;
  over_ = over ? static_cast<std::uint8_t>(over_ + 1) : std::uint8_t{0};
  if (over_ >= kTripSamples) {
    go_off();
    tripped_ = true;
    return;
  }
  if (phase_ != Phase::turning) return;
  // A commutation in here would lie after `now`: the sector would seem over, and a step be skipped.
  const hal::InterruptLock lock;
  const Commutation::Order order =
      commutation_.on_sample(bridge::now(), sample.floating, sample.bus);
  if (order.commutate) bridge::interrupt_at(order.at);
}

void MotorDrive::on_commutation() {
  bridge::acknowledge_interrupt();
  if (phase_ != Phase::turning) return;
  bridge::apply(commutation_.step());
  sampling::select_floating(bridge::floating_phase(commutation_.step()));
  commutation_.on_commutated(bridge::now());
}

void MotorDrive::follow(const Drive& wanted) {
  const hal::InterruptLock lock;
  if (!wanted.energised) {
    if (phase_ != Phase::off) go_off();
    return;
  }
  bridge::set_duty(wanted.duty);
  switch (phase_) {
    case Phase::off:
      bridge::apply(0);
      phase_ = Phase::aligning;
      return;
    case Phase::aligning:
      if (++align_ms_ < kAlign_ms) return;
      phase_ = Phase::turning;
      bridge::interrupt_at(commutation_.start(bridge::now()).at);
      return;
    case Phase::turning:
      return;
  }
}

Sensed MotorDrive::sense() {
  std::uint32_t shunt = 0, bus = 0, n = 0;
  float speed = 0.0f;
  bool in_sync = false;
  {
    const hal::InterruptLock lock;
    shunt = shunt_sum_;
    bus = bus_sum_;
    n = samples_;
    shunt_sum_ = bus_sum_ = samples_ = 0;
    speed = commutation_.speed_radps();
    in_sync = commutation_.in_sync();
  }
  const float per_sample = n > 0 ? 1.0f / static_cast<float>(n) : 0.0f;
  return {.bus_voltage_V = static_cast<float>(bus) * per_sample * sampling::kVolts_per_count,
          .bus_current_A = static_cast<float>(shunt) * per_sample * sampling::kAmperes_per_count,
          .speed_radps = speed_.update(speed, in_sync),
          .in_sync = in_sync};
}

bool MotorDrive::tripped() {
  const bool was = tripped_;
  tripped_ = false;
  return was;
}

}  // namespace fw::esc
