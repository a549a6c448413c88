#include "io_bridges/devices/imu_node.hpp"

#include "io_bridges/protocols/dronecan/imu_samples.hpp"
#include "io_bridges/protocols/dronecan/sensors.hpp"

namespace whirl::io {
namespace {

constexpr std::uint8_t kImuNode_urgent = 6;  // below it only set-points
constexpr std::uint32_t kImuNode_slow_Hz = 1'000'000, kImuNode_fast_Hz = 10'000'000;
constexpr int kImuNode_mode = 3;
constexpr Nanoseconds kImuNode_burst_ns = 15 * 8 * 100;
constexpr Nanoseconds kImuNode_powerUp_ns = 20'000'000, kImuNode_look_ns = 50'000'000;
constexpr std::uint8_t kImuNode_read = 0x80, kImuNode_first_data = 0x3B;

}  // namespace

ImuNode::ImuNode(EventQueue& queue, CanBus& bus, const Setup& setup, Mpu6000::Sense sense,
                 FaultBook* faults, FindingSink findings)
    : queue_(queue),
      setup_(setup),
      node_(queue, bus, setup.node),
      part_(queue, setup.part, std::move(sense), &interrupt_, faults, std::move(findings)),
      burst_over_(queue, [this] { read_burst(); }),
      look_(queue, [this] {
        if (!std::exchange(heard_, false)) set_up();
        look_.in(kImuNode_look_ns);
      }) {
  interrupt_.watch([this](bool level, Nanoseconds now) {
    if (!level) return;
    ready_ns_ = now;
    if (setup_.on_ready) setup_.on_ready(now);
    burst_over_.in(kImuNode_burst_ns);
  });
  look_.in(kImuNode_powerUp_ns);
}

void ImuNode::write(std::uint8_t address, std::uint8_t value) {
  const Nanoseconds now = queue_.now();
  part_.select(true, now);
  part_.transfer(address, kImuNode_slow_Hz, kImuNode_mode, now);
  part_.transfer(value, kImuNode_slow_Hz, kImuNode_mode, now);
  part_.select(false, now);
}

void ImuNode::set_up() {
  constexpr std::uint8_t kSettings[][2] = {
      {0x6B, 0x01},   // PWR_MGMT_1: awake, clock from the gyro's PLL
      {0x6A, 0x10},   // USER_CTRL: I2C off
      {0x19, 0x00},   // SMPLRT_DIV: 1 kHz
      {0x1A, 0x01},   // CONFIG: 188 Hz
      {0x1B, 0x18},   // GYRO_CONFIG: +-2000 deg/s
      {0x1C, 0x18},   // ACCEL_CONFIG: +-16 g
      {0x37, 0x10},   // INT_PIN_CFG: a pulse, cleared by any read
      {0x38, 0x01}};  // INT_ENABLE: data ready
  for (const auto& [address, value] : kSettings) write(address, value);
}

void ImuNode::read_burst() {
  const Nanoseconds now = queue_.now();
  std::array<std::int16_t, 7> counts{};
  part_.select(true, now);
  part_.transfer(kImuNode_first_data | kImuNode_read, kImuNode_fast_Hz, kImuNode_mode, now);
  for (std::int16_t& word : counts) {
    const int high = part_.transfer(0, kImuNode_fast_Hz, kImuNode_mode, now);
    word = static_cast<std::int16_t>(high << 8 |
                                     part_.transfer(0, kImuNode_fast_Hz, kImuNode_mode, now));
  }
  part_.select(false, now);
  heard_ = true;
  Triple acceleration_mps2{}, rate_radps{};  // temperature stands between them
  for (std::size_t i = 0; i < 3; ++i) {
    acceleration_mps2[i] = counts[i] * dronecan::Imu16::kAcceleration_step_mps2;
    rate_radps[i] = counts[i + 4] * dronecan::Imu16::kRate_step_radps;
  }
  acceleration_mps2 = setup_.to_body(acceleration_mps2);
  rate_radps = setup_.to_body(rate_radps);
  switch (setup_.form) {
    case Setup::Form::imu14:
      return publish<dronecan::Imu14>(acceleration_mps2, rate_radps);
    case Setup::Form::imu16:
      return publish<dronecan::Imu16>(acceleration_mps2, rate_radps);
    case Setup::Form::raw:
      return add_raw(acceleration_mps2, rate_radps);
  }
}

void ImuNode::add_raw(const Triple& acceleration_mps2, const Triple& rate_radps) {
  if (added_ns_ >= 0) {
    const double dt_s = static_cast<double>(ready_ns_ - added_ns_) * 1e-9;
    integrated_ns_ += ready_ns_ - added_ns_;
    for (std::size_t i = 0; i < 3; ++i) {
      velocity_mps_[i] += acceleration_mps2[i] * dt_s;
      angle_rad_[i] += rate_radps[i] * dt_s;
    }
  }
  added_ns_ = ready_ns_;
  if (++added_ < setup_.every) return;
  dronecan::RawImu message;
  message.integration_interval_s = static_cast<float>(static_cast<double>(integrated_ns_) * 1e-9);
  for (std::size_t i = 0; i < 3; ++i) {
    message.rate_radps[i] = static_cast<float>(rate_radps[i]);
    message.rate_integral_rad[i] = static_cast<float>(angle_rad_[i]);
    message.acceleration_mps2[i] = static_cast<float>(acceleration_mps2[i]);
    message.acceleration_integral_mps[i] = static_cast<float>(velocity_mps_[i]);
  }
  node_.send(message, kImuNode_urgent);
  added_ = 0;
  integrated_ns_ = 0;
  velocity_mps_ = angle_rad_ = {};
}

template <typename Message>
void ImuNode::publish(const Triple& acceleration_mps2, const Triple& rate_radps) {
  Message message;
  for (std::size_t i = 0; i < 3; ++i) {
    message.acceleration[i] =
        dronecan::to_steps<Message>(acceleration_mps2[i], Message::kAcceleration_step_mps2);
    message.rate[i] = dronecan::to_steps<Message>(rate_radps[i], Message::kRate_step_radps);
  }
  message.time = static_cast<std::uint16_t>(ready_ns_ / Message::kTime_step_ns);
  node_.send(message, kImuNode_urgent);
}

}  // namespace whirl::io
