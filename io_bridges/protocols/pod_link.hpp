// The frames between a host and the pod on its UART: 0xA5, kind, sequence, length, payload, CRC-16/MCRF4XX
// over kind to payload, low byte first.
//
//   To the pod   0x01 sample: flags, accelerometer x y z, temperature, gyro x y z (int16, counts)
//                0x02 faults: flags (bit 0 frozen, bit 1 no supply), identity (0: its own)
//   From it      0x81 status (44 bytes): settings, what was lost or late, and counters
//   Errors       a damaged or unknown frame is skipped and counted
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace whirl::io {

inline constexpr std::size_t kPodSampleBytes = 21;  // on the line

struct PodStatus {
  std::array<std::uint8_t, 8>
      settings{};  // PWR_MGMT_1, CONFIG, SMPLRT_DIV, GYRO_CONFIG, ACCEL_CONFIG,
                   // INT_ENABLE, INT_PIN_CFG, USER_CTRL
  std::uint8_t newest_sample = 0, newest_oddity = 0;
  bool overdue = false;
  std::uint32_t flagged = 0;  // bit 0: the newest sample; set: it was lost or late
  std::uint16_t lost = 0, late = 0, damaged = 0, oddities = 0, overlaps = 0, late_rearm = 0;
  std::uint32_t transfers = 0, bursts = 0, samples = 0, longest_turn_us = 0;
};

std::vector<std::uint8_t> pack_pod_sample(std::uint8_t sequence,
                                          const std::array<std::int16_t, 7>& counts);
std::vector<std::uint8_t> pack_pod_faults(std::uint8_t sequence, bool frozen, bool no_supply,
                                          std::uint8_t identity);

class PodLinkReader {
 public:
  explicit PodLinkReader(std::function<void(const PodStatus&)> on_status)
      : on_status_(std::move(on_status)) {}
  void add(std::uint8_t byte);
  std::uint64_t damaged() const { return damaged_; }

 private:
  void frame();

  std::function<void(const PodStatus&)> on_status_;
  std::vector<std::uint8_t> bytes_;
  std::uint64_t damaged_ = 0;
};

}  // namespace whirl::io
