#include "firmware/pod/host_link.hpp"

#include <algorithm>
#include <array>

#include "firmware/pod/battery_out.hpp"
#include "firmware/pod/escs.hpp"
#include "firmware/pod/host_can.hpp"
#include "firmware/pod/host_uart.hpp"
#include "firmware/pod/imu.hpp"
#include "firmware/pod/played_line.hpp"
#include "firmware/pod/receiver_out.hpp"
#include "firmware/pod/sensors.hpp"

namespace fw::pod {
namespace {

namespace mpu = whirl::core::mpu;

constexpr std::uint32_t kStatus_us = 10'000,
                        kStatus_on_can_us = 30'000;  // of the newest 32 samples, 1 ms each
constexpr std::uint8_t kFrozen = 1, kNo_supply = 2;
constexpr std::uint8_t kSample_bytes = 16, kFault_bytes = 2, kBaud_bytes = 4, kLevel_bytes = 2;
constexpr std::uint8_t kTold[] = {mpu::PWR_MGMT_1,  mpu::CONFIG,       mpu::SMPLRT_DIV,
                                  mpu::GYRO_CONFIG, mpu::ACCEL_CONFIG, mpu::INT_ENABLE,
                                  mpu::INT_PIN_CFG, mpu::USER_CTRL};

// What a frame says to a line of its kinds; others say nothing to it.
template <typename Line>
void play(const Frame& frame, FrameKind bytes, FrameKind baud, Line& line) {
  constexpr std::size_t kTime = 4;
  if (frame.kind == bytes && frame.length > kTime && frame.length <= kTime + kLinePiece) {
    line.add(frame.whole(0), frame.bytes(kTime));
  }
  if (frame.kind == baud && frame.length == kBaud_bytes) line.add_baud(frame.whole(0));
}

}  // namespace

constinit HostLink host_link;

void HostLink::start() {
  host_uart.init(kHostBaud);
  host_can.start();
}

void HostLink::poll(std::uint32_t now_us) {
  longest_turn_us_ = std::max(longest_turn_us_, turned_us_ == 0 ? 0u : now_us - turned_us_);
  turned_us_ = now_us;
  std::array<std::uint8_t, 32> bytes{};
  const std::size_t n = host_uart.read(bytes);
  for (std::size_t i = 0; i < n; ++i) {
    if (!reader_.add(bytes[i])) continue;
    over_can_ = false;
    on_frame(reader_.frame(), now_us);
  }
  if (Frame frame; host_can.read(frame, now_us)) {
    over_can_ = true;
    on_frame(frame, now_us);
  }
  host_can.poll(now_us);
  send_setpoints();
  send_written(FrameKind::gps_written, gps_number_, gps_out.take_written(now_us), now_us);
  send_written(FrameKind::radio_written, radio_number_, radio_out.take_written(now_us), now_us);
  if (static_cast<std::int32_t>(now_us - status_due_us_) >= 0) send_status(now_us);
}

void HostLink::on_frame(const Frame& frame, std::uint32_t now_us) {
  if (frame.kind == FrameKind::sample && frame.length == kSample_bytes) {
    PodImu::Counts counts{};
    for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = frame.word(2 + 2 * i);
    const SampleClock::Place place = clock_.place(frame.half(0), now_us);
    imu.sample(counts, place.due_us);
    watch_.came(frame.sequence, place.due_us, place.late);
  }
  if (frame.kind == FrameKind::faults && frame.length == kFault_bytes) {
    const std::uint8_t flags = frame.payload[0];
    imu.set_faults((flags & kFrozen) != 0, (flags & kNo_supply) == 0, frame.payload[1]);
  }
  on_slow_frame(frame);
  on_output(frame, now_us);
}

// For the parts on I2C.
void HostLink::on_slow_frame(const Frame& frame) {
  if (frame.kind == FrameKind::barometer && frame.length == 5) {
    barometer.set_counts(frame.payload[0], frame.whole(1));
  }
  if (frame.kind == FrameKind::prom && frame.length == 16) {
    whirl::core::Ms5611::Prom prom{};
    for (std::size_t i = 0; i < prom.size(); ++i) prom[i] = frame.half(2 * i);
    barometer.set_prom(prom);
  }
  if (frame.kind == FrameKind::magnetometer && frame.length == 6) {
    magnetometer.set_counts({frame.word(0), frame.word(2), frame.word(4)});
  }
  if (frame.kind == FrameKind::esc && frame.length == 6 && frame.payload[0] < kEscs) {
    escs[frame.payload[0]].set_status({frame.word(1), frame.half(3), frame.payload[5]});
  }
}

// For the lines of GPS, radio and receiver, and the battery's level.
void HostLink::on_output(const Frame& frame, std::uint32_t now_us) {
  play(frame, FrameKind::gps, FrameKind::gps_baud, gps_out);
  play(frame, FrameKind::radio, FrameKind::radio_baud, radio_out);
  if (frame.kind == FrameKind::battery && frame.length == kLevel_bytes) {
    battery_out.set(frame.half(0));
  }
  if (frame.kind == FrameKind::sbus && frame.length == SbusOut::kData) {
    sbus_out.set(frame.bytes(0), now_us);
  }
  if (frame.kind == FrameKind::cppm && frame.length % 2 == 0) {
    std::array<std::uint16_t, CppmOut::kMost> steps{};
    const std::size_t n = std::min<std::size_t>(frame.length / 2, steps.size());
    for (std::size_t i = 0; i < n; ++i) steps[i] = frame.half(2 * i);
    cppm_out.set(std::span(steps).first(n), now_us);
  }
}

void HostLink::send(FrameWriter& frame) {
  const bool sent = over_can_ ? host_can.send(frame) : host_uart.send(frame.finish()) == Status::ok;
  if (!sent) ++unsent_;
}

void HostLink::send_setpoints() {
  for (std::size_t i = 0; i < kEscs; ++i) {
    const auto came = escs[i].take_write();
    if (!came) continue;
    FrameWriter out(FrameKind::setpoint, setpoint_number_++);
    out.byte(static_cast<std::uint32_t>(i));
    out.byte(came->valid ? 1 : 0);
    out.half(came->v);
    send(out);
  }
}

void HostLink::send_written(FrameKind kind, std::uint8_t& number,
                            std::span<const std::uint8_t> bytes, std::uint32_t now_us) {
  if (bytes.empty()) return;
  FrameWriter out(kind, number++);
  out.word(now_us);
  for (const std::uint8_t byte : bytes) out.byte(byte);
  send(out);
}

void HostLink::send_status(std::uint32_t now_us) {
  status_due_us_ = now_us + (over_can_ ? kStatus_on_can_us : kStatus_us);
  const SpiCounters& spi = spi_counters();
  FrameWriter out(FrameKind::status, status_number_++);
  for (const std::uint8_t address : kTold) out.byte(imu.setting(address));
  out.byte(watch_.last());
  out.byte(imu.last_oddity());
  out.byte(watch_.overdue(now_us) ? 1 : 0);
  out.byte(0);
  out.word(watch_.flagged());
  for (const std::uint32_t count :
       {watch_.lost(), watch_.late(), reader_.damaged() + host_can.damaged(),
        imu.oddities() + barometer.oddities() + magnetometer.oddities(), imu.overlaps(),
        spi.late_rearm}) {
    out.half(std::min<std::uint32_t>(count, 0xFFFF));
  }
  for (const std::uint32_t count :
       {spi.transfers, spi.bursts, imu.samples(), longest_turn_us_, now_us}) {
    out.word(count);
  }
  for (const std::uint32_t count :
       {gps_out.dropped(), unsent_, clock_.longest_wait_us(), radio_out.dropped()}) {
    out.half(std::min<std::uint32_t>(count, 0xFFFF));
  }
  send(out);
}

}  // namespace fw::pod
