#include "firmware/pod/host_link.hpp"

#include <algorithm>
#include <tuple>

#include "firmware/pod/escs.hpp"
#include "firmware/pod/host_uart.hpp"
#include "firmware/pod/imu.hpp"
#include "firmware/pod/sensors.hpp"

namespace fw::pod {
namespace {

namespace mpu = whirl::core::mpu;

constexpr std::uint32_t kStatus_us = 10'000;
constexpr std::uint8_t kFrozen = 1, kNo_supply = 2;
constexpr std::uint8_t kSample_bytes = 15, kFault_bytes = 2;
constexpr std::uint8_t kTold[] = {mpu::PWR_MGMT_1,  mpu::CONFIG,       mpu::SMPLRT_DIV,
                                  mpu::GYRO_CONFIG, mpu::ACCEL_CONFIG, mpu::INT_ENABLE,
                                  mpu::INT_PIN_CFG, mpu::USER_CTRL};

}  // namespace

constinit HostLink host_link;

void HostLink::start() {
  host_uart.init(kHostBaud);
}

void HostLink::poll(std::uint32_t now_us) {
  longest_turn_us_ = std::max(longest_turn_us_, turned_us_ == 0 ? 0u : now_us - turned_us_);
  turned_us_ = now_us;
  std::array<std::uint8_t, 32> bytes{};
  const std::size_t n = host_uart.read(bytes);
  for (std::size_t i = 0; i < n; ++i) {
    if (reader_.add(bytes[i])) on_frame(reader_.frame(), now_us);
  }
  send_setpoints();
  if (static_cast<std::int32_t>(now_us - status_due_us_) >= 0) send_status(now_us);
}

void HostLink::on_frame(const Frame& frame, std::uint32_t now_us) {
  if (frame.kind == FrameKind::sample && frame.length == kSample_bytes) {
    std::array<std::int16_t, 7> counts{};
    for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = frame.word(1 + 2 * i);
    imu.sample(counts);
    watch_.came(frame.sequence, now_us);
  }
  if (frame.kind == FrameKind::faults && frame.length == kFault_bytes) {
    const std::uint8_t flags = frame.payload[0];
    imu.set_faults((flags & kFrozen) != 0, (flags & kNo_supply) == 0, frame.payload[1]);
  }
  on_slow_frame(frame);
}

// For the parts on I2C.
void HostLink::on_slow_frame(const Frame& frame) {
  const auto half = [&](std::size_t at) { return static_cast<std::uint16_t>(frame.word(at)); };
  if (frame.kind == FrameKind::barometer && frame.length == 5) {
    barometer.set_counts(frame.payload[0], half(1) | static_cast<std::uint32_t>(half(3)) << 16);
  }
  if (frame.kind == FrameKind::prom && frame.length == 16) {
    whirl::core::Ms5611::Prom prom{};
    for (std::size_t i = 0; i < prom.size(); ++i) prom[i] = half(2 * i);
    barometer.set_prom(prom);
  }
  if (frame.kind == FrameKind::magnetometer && frame.length == 6) {
    magnetometer.set_counts({frame.word(0), frame.word(2), frame.word(4)});
  }
  if (frame.kind == FrameKind::esc && frame.length == 6 && frame.payload[0] < kEscs) {
    escs[frame.payload[0]].set_status({frame.word(1), half(3), frame.payload[5]});
  }
}

void HostLink::send_setpoints() {
  for (std::size_t i = 0; i < kEscs; ++i) {
    const auto came = escs[i].take_write();
    if (!came) continue;
    FrameWriter out(FrameKind::setpoint, setpoint_number_++);
    out.byte(static_cast<std::uint32_t>(i));
    out.byte(came->valid ? 1 : 0);
    out.half(came->v);
    std::ignore = host_uart.send(out.finish());
  }
}

void HostLink::send_status(std::uint32_t now_us) {
  status_due_us_ = now_us + kStatus_us;
  const SpiCounters& spi = spi_counters();
  FrameWriter out(FrameKind::status, status_number_++);
  for (const std::uint8_t address : kTold) out.byte(imu.setting(address));
  out.byte(watch_.last());
  out.byte(imu.last_oddity());
  out.byte(watch_.overdue(now_us) ? 1 : 0);
  out.byte(0);
  out.word(watch_.flagged());
  for (const std::uint32_t count : {watch_.lost(), watch_.late(), reader_.damaged(),
                                    imu.oddities() + barometer.oddities() + magnetometer.oddities(),
                                    imu.overlaps(), spi.late_rearm}) {
    out.half(std::min<std::uint32_t>(count, 0xFFFF));
  }
  for (const std::uint32_t count : {spi.transfers, spi.bursts, imu.samples(), longest_turn_us_}) {
    out.word(count);
  }
  std::ignore = host_uart.send(out.finish());  // the next one tells more
}

}  // namespace fw::pod
