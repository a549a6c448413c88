#include "io_bridges/protocols/pod_link.hpp"

#include <algorithm>

#include "io_bridges/protocols/crc.hpp"

namespace whirl::io {
namespace {

constexpr std::uint8_t kStart = 0xA5, kSample = 0x01, kFaults = 0x02, kBarometer = 0x03,
                       kProm = 0x04, kMagnetometer = 0x05, kEsc = 0x06, kStatus = 0x81,
                       kSetpoint = 0x82;
constexpr std::size_t kHead = 4, kTail = 2, kStatusBytes = 44, kSetpointBytes = 4;

std::uint16_t checksum(std::span<const std::uint8_t> bytes) {
  std::uint16_t crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) crc = crc16_add(crc, byte);
  return crc;
}

void add_half(std::vector<std::uint8_t>& bytes, std::uint16_t value) {
  bytes.push_back(static_cast<std::uint8_t>(value & 0xFF));
  bytes.push_back(static_cast<std::uint8_t>(value >> 8));
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
  for (auto* field :
       {&status.transfers, &status.bursts, &status.samples, &status.longest_turn_us}) {
    *field = walk.next(4);
  }
  return status;
}

}  // namespace

std::vector<std::uint8_t> pack_pod_sample(std::uint8_t sequence,
                                          const std::array<std::int16_t, 7>& counts) {
  std::vector<std::uint8_t> frame{kStart, kSample, sequence, 0, 0};
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
  add_half(frame, static_cast<std::uint16_t>(counts & 0xFFFF));
  add_half(frame, static_cast<std::uint16_t>(counts >> 16));
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
  if (good && all[1] == kStatus && all[3] == kStatusBytes) {
    return on_status_(pod_status(all.subspan(kHead, kStatusBytes)));
  }
  if (good && all[1] == kSetpoint && all[3] == kSetpointBytes) {
    const auto value = static_cast<std::uint16_t>(all[kHead + 2] | all[kHead + 3] << 8);
    if (on_setpoint_) on_setpoint_({all[kHead], all[kHead + 1] != 0, value});
    return;
  }
  ++damaged_;
}

}  // namespace whirl::io
