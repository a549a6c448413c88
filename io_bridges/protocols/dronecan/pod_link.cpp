#include "io_bridges/protocols/dronecan/pod_link.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/check.hpp"
#include "io_bridges/protocols/crc.hpp"

namespace whirl::io {
namespace {

constexpr std::uint8_t kStart = 0xA5, kSample = 0x01, kFaults = 0x02, kBarometer = 0x03,
                       kProm = 0x04, kMagnetometer = 0x05, kEsc = 0x06, kGps = 0x07,
                       kGpsBaud = 0x08, kSbus = 0x09, kCppm = 0x0A, kRadio = 0x0B,
                       kRadioBaud = 0x0C, kBattery = 0x0D, kStatus = 0x81, kSetpoint = 0x82,
                       kGpsWritten = 0x83, kRadioWritten = 0x84;
constexpr std::size_t kHead = 4, kTail = 2, kStatusBytes = 56, kSetpointBytes = 4;
constexpr double kMostLevel = 4095.0;
constexpr std::uint8_t kSilent = 0x80;  // of SBUS's flags

std::uint16_t checksum(std::span<const std::uint8_t> bytes) {
  std::uint16_t crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) crc = crc16_add(crc, byte);
  return crc;
}

void add_half(std::vector<std::uint8_t>& bytes, std::uint16_t value) {
  bytes.push_back(static_cast<std::uint8_t>(value & 0xFF));
  bytes.push_back(static_cast<std::uint8_t>(value >> 8));
}

void add_whole(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
  add_half(bytes, static_cast<std::uint16_t>(value & 0xFFFF));
  add_half(bytes, static_cast<std::uint16_t>(value >> 16));
}

std::vector<std::uint8_t> sealed(std::vector<std::uint8_t> frame) {
  frame[3] = static_cast<std::uint8_t>(frame.size() - kHead);
  add_half(frame, checksum(std::span(frame).subspan(1)));
  return frame;
}

struct Walk {
  std::span<const std::uint8_t> bytes;
  std::uint32_t next(int count) {
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i) value |= static_cast<std::uint32_t>(bytes[0 + i]) << (8 * i);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
    return value;
  }
  std::uint16_t half() { return static_cast<std::uint16_t>(next(2)); }
};

PodStatus pod_status(std::span<const std::uint8_t> payload) {
  PodStatus status;
  std::copy_n(payload.begin(), status.settings.size(), status.settings.begin());
  Walk walk{payload.subspan(status.settings.size())};
  status.newest_sample = static_cast<std::uint8_t>(walk.next(1));
  status.newest_oddity = static_cast<std::uint8_t>(walk.next(1));
  status.overdue = walk.next(2) != 0;
  status.flagged = walk.next(4);
  for (auto* field : {&status.lost, &status.late, &status.damaged, &status.oddities,
                      &status.overlaps, &status.late_rearm}) {
    *field = walk.half();
  }
  for (auto* field : {&status.transfers, &status.bursts, &status.samples, &status.longest_turn_us,
                      &status.now_us}) {
    *field = walk.next(4);
  }
  status.gps_dropped = walk.half();
  status.unsent = walk.half();
  status.wait_us = walk.half();
  status.radio_dropped = walk.half();
  return status;
}

}  // namespace

void PodFlags::add(const PodStatus& status) {
  constexpr unsigned kTold = 32;
  const unsigned came = begun_ ? static_cast<std::uint8_t>(status.newest_sample - newest_) : 0;
  begun_ = true;
  newest_ = status.newest_sample;
  const unsigned told = std::min(came, kTold);
  untold_ += came - told;
  const std::uint64_t of_these = (std::uint64_t{1} << told) - 1;
  flagged_ += static_cast<std::uint64_t>(std::popcount(status.flagged & of_these));
}

std::vector<std::uint8_t> pack_pod_sample(std::uint8_t sequence, std::uint16_t time_us,
                                          const std::array<std::int16_t, 7>& counts) {
  std::vector<std::uint8_t> frame{kStart, kSample, sequence, 0};
  add_half(frame, time_us);
  for (const std::int16_t count : counts) add_half(frame, static_cast<std::uint16_t>(count));
  return sealed(std::move(frame));
}

std::vector<std::uint8_t> pack_pod_faults(std::uint8_t sequence, bool frozen, bool no_supply,
                                          std::uint8_t identity) {
  const auto flags = static_cast<std::uint8_t>((frozen ? 1 : 0) | (no_supply ? 2 : 0));
  return sealed({kStart, kFaults, sequence, 0, flags, identity});
}

std::vector<std::uint8_t> pack_pod_barometer(std::uint8_t sequence, std::uint8_t quantity,
                                             std::uint32_t counts) {
  std::vector<std::uint8_t> frame{kStart, kBarometer, sequence, 0, quantity};
  add_whole(frame, counts);
  return sealed(std::move(frame));
}

std::vector<std::uint8_t> pack_pod_prom(std::uint8_t sequence,
                                        const std::array<std::uint16_t, 8>& words) {
  std::vector<std::uint8_t> frame{kStart, kProm, sequence, 0};
  for (const std::uint16_t word : words) add_half(frame, word);
  return sealed(std::move(frame));
}

std::vector<std::uint8_t> pack_pod_magnetometer(std::uint8_t sequence,
                                                const std::array<std::int16_t, 3>& counts) {
  std::vector<std::uint8_t> frame{kStart, kMagnetometer, sequence, 0};
  for (const std::int16_t count : counts) add_half(frame, static_cast<std::uint16_t>(count));
  return sealed(std::move(frame));
}

std::vector<std::uint8_t> pack_pod_esc(std::uint8_t sequence, std::uint8_t esc,
                                       std::int16_t current_mA, std::uint16_t speed_rpm,
                                       std::uint8_t flags) {
  std::vector<std::uint8_t> frame{kStart, kEsc, sequence, 0, esc};
  add_half(frame, static_cast<std::uint16_t>(current_mA));
  add_half(frame, speed_rpm);
  frame.push_back(flags);
  return sealed(std::move(frame));
}

std::vector<std::uint8_t> pack_pod_bytes(PodEnd line, std::uint8_t sequence, std::uint32_t at_us,
                                         std::span<const std::uint8_t> bytes) {
  WHIRL_CHECK(bytes.size() <= kPodLineBytes, bytes.size());
  std::vector<std::uint8_t> frame{kStart, line == PodEnd::gps ? kGps : kRadio, sequence, 0};
  add_whole(frame, at_us);
  frame.insert(frame.end(), bytes.begin(), bytes.end());
  return sealed(std::move(frame));
}

std::vector<std::uint8_t> pack_pod_baud(PodEnd line, std::uint8_t sequence, std::uint32_t baud) {
  std::vector<std::uint8_t> frame{kStart, line == PodEnd::gps ? kGpsBaud : kRadioBaud, sequence, 0};
  add_whole(frame, baud);
  return sealed(std::move(frame));
}

std::vector<std::uint8_t> pack_pod_battery(std::uint8_t sequence, double level) {
  std::vector<std::uint8_t> frame{kStart, kBattery, sequence, 0};
  add_half(frame,
           static_cast<std::uint16_t>(std::lround(std::clamp(level, 0.0, 1.0) * kMostLevel)));
  return sealed(std::move(frame));
}

std::vector<std::uint8_t> pack_pod_sbus(std::uint8_t sequence, const SbusFrame& frame,
                                        bool silent) {
  const auto on_line = encode(frame);
  std::vector<std::uint8_t> bytes{kStart, kSbus, sequence, 0};
  bytes.insert(bytes.end(), on_line.begin() + 1, on_line.end() - 1);
  if (silent) bytes.back() |= kSilent;
  return sealed(std::move(bytes));
}

std::vector<std::uint8_t> pack_pod_cppm(std::uint8_t sequence,
                                        std::span<const std::uint16_t> steps) {
  std::vector<std::uint8_t> frame{kStart, kCppm, sequence, 0};
  for (const std::uint16_t step : steps) add_half(frame, step);
  return sealed(std::move(frame));
}

dronecan::PodFrame pod_message(std::span<const std::uint8_t> frame) {
  dronecan::PodFrame message;
  message.kind = frame[1];
  message.sequence = frame[2];
  for (const std::uint8_t byte : frame.subspan(kHead, frame[3])) message.payload.add(byte);
  return message;
}

void PodLinkReader::add(std::uint8_t byte) {
  if (bytes_.empty() && byte != kStart) return;
  bytes_.push_back(byte);
  if (bytes_.size() < kHead || bytes_.size() < kHead + bytes_[3] + kTail) return;
  frame();
  bytes_.clear();
}

void PodLinkReader::frame() {
  const auto all = std::span<const std::uint8_t>(bytes_);
  const std::size_t end = all.size() - kTail;
  const bool good = checksum(all.subspan(1, end - 1)) == (all[end] | all[end + 1] << 8);
  if (!good || !on_frame(all[1], all.subspan(kHead, all[3]))) ++damaged_;
}

void PodLinkReader::add(const dronecan::PodFrame& message) {
  if (!on_frame(message.kind, message.payload.all())) ++damaged_;
}

void PodLinkReader::add(const dronecan::PodSetpoint& message) {
  if (on_setpoint_) on_setpoint_({message.esc, message.valid != 0, message.value});
}

// False: of no kind, or not as long as its kind.
bool PodLinkReader::on_frame(std::uint8_t kind, std::span<const std::uint8_t> payload) {
  constexpr std::size_t kTime = 4;
  Walk walk{payload};
  if (kind == kStatus && payload.size() == kStatusBytes) {
    on_status_(pod_status(payload));
  } else if (kind == kSetpoint && payload.size() == kSetpointBytes) {
    const auto esc = static_cast<std::uint8_t>(walk.next(1));
    const bool valid = walk.next(1) != 0;
    if (on_setpoint_) on_setpoint_({esc, valid, walk.half()});
  } else if ((kind == kGpsWritten || kind == kRadioWritten) && payload.size() > kTime) {
    const std::uint32_t t_us = walk.next(kTime);
    const auto& told = kind == kGpsWritten ? on_gps_written_ : on_radio_written_;
    if (told) told({t_us, walk.bytes});
  } else {
    return false;
  }
  return true;
}

}  // namespace whirl::io
