// The frames between a host and the pod on its UART: 0xA5, kind, sequence, length, payload, CRC-16/MCRF4XX
// over kind to payload, low byte first. Over CAN they are messages: dronecan/pod.hpp.
//
//   To the pod   0x01 sample: the host's time of it (us, 16 bits), accelerometer x y z, temperature, gyro x y z (int16, counts)
//                0x02 faults: flags (bit 0 frozen, bit 1 no supply), identity (0: its own)
//                0x03 barometer: quantity (0 pressure, 1 temperature), counts; 0x04 its PROM
//                0x05 magnetometer: x, y, z; 0x06 an ESC's status: number, mA, rpm, flags
//                0x07 bytes of the GPS, from when on by the pod's clock (us; 0: at once); 0x08 its baud rate
//                0x09 SBUS: channels as on the line and flags; 0x0A CPPM: lengths of its channels
//                0x0B bytes of the radio, as of the GPS; 0x0C its baud rate; 0x0D the battery's level at the ADC, of 4095
//   From it      0x81 status (56 bytes): settings, what was lost or late, and counters
//                0x82 a set-point came: number of the ESC, 1: valid, value
//                0x83 bytes that the flight controller told the GPS, and when the pod tells it; 0x84 the same of the radio
//   Errors       a damaged or unknown frame is skipped and counted
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "io_bridges/protocols/dronecan/pod.hpp"
#include "io_bridges/protocols/sbus.hpp"

namespace whirl::io {

inline constexpr double kPodBaud = 3e6;
inline constexpr std::size_t kPodSampleBytes = 22;  // on the line

struct PodStatus {
  std::array<std::uint8_t, 8>
      settings{};  // PWR_MGMT_1, CONFIG, SMPLRT_DIV, GYRO_CONFIG, ACCEL_CONFIG,
                   // INT_ENABLE, INT_PIN_CFG, USER_CTRL
  std::uint8_t newest_sample = 0, newest_oddity = 0;
  bool overdue = false;
  std::uint32_t flagged = 0;  // bit 0: the newest sample; set: it was lost or late
  std::uint16_t lost = 0, late = 0, damaged = 0, oddities = 0, overlaps = 0, late_rearm = 0;
  std::uint32_t transfers = 0, bursts = 0, samples = 0, longest_turn_us = 0;
  std::uint32_t now_us = 0;  // the pod's clock
  std::uint16_t gps_dropped = 0, unsent = 0;
  std::uint16_t wait_us = 0;  // the longest of a sample for its time, of the last whole second
  std::uint16_t radio_dropped = 0;
};

// What the statuses have marked of the samples, each sample once. A status tells of the newest 32: where more have come since the
// one before, the older ones stand in none. Valid: fewer than 256 samples from status to status.
class PodFlags {
 public:
  void add(const PodStatus& status);
  std::uint64_t flagged() const { return flagged_; }  // lost or late
  std::uint64_t untold() const { return untold_; }

 private:
  bool begun_ = false;
  std::uint8_t newest_ = 0;
  std::uint64_t flagged_ = 0, untold_ = 0;
};

std::vector<std::uint8_t> pack_pod_sample(std::uint8_t sequence, std::uint16_t time_us,
                                          const std::array<std::int16_t, 7>& counts);
std::vector<std::uint8_t> pack_pod_faults(std::uint8_t sequence, bool frozen, bool no_supply,
                                          std::uint8_t identity);

std::vector<std::uint8_t> pack_pod_barometer(std::uint8_t sequence, std::uint8_t quantity,
                                             std::uint32_t counts);
std::vector<std::uint8_t> pack_pod_prom(std::uint8_t sequence,
                                        const std::array<std::uint16_t, 8>& words);
std::vector<std::uint8_t> pack_pod_magnetometer(std::uint8_t sequence,
                                                const std::array<std::int16_t, 3>& counts);
std::vector<std::uint8_t> pack_pod_esc(std::uint8_t sequence, std::uint8_t esc,
                                       std::int16_t current_mA, std::uint16_t speed_rpm,
                                       std::uint8_t flags);

// A line at whose end the host plays a device.
enum class PodEnd : std::uint8_t { gps, radio };
// At most kPodLineBytes; at_us: see above.
inline constexpr std::size_t kPodLineBytes = 44;
std::vector<std::uint8_t> pack_pod_bytes(PodEnd line, std::uint8_t sequence, std::uint32_t at_us,
                                         std::span<const std::uint8_t> bytes);
std::vector<std::uint8_t> pack_pod_baud(PodEnd line, std::uint8_t sequence, std::uint32_t baud);
// At the flight controller's ADC, of the pod's supply: 0 to 1, held there.
std::vector<std::uint8_t> pack_pod_battery(std::uint8_t sequence, double level);
// Of an SBUS frame the channels and flags; `silent`: nothing goes out.
std::vector<std::uint8_t> pack_pod_sbus(std::uint8_t sequence, const SbusFrame& frame,
                                        bool silent = false);
// In steps of 0.5 us; none: nothing goes out.
std::vector<std::uint8_t> pack_pod_cppm(std::uint8_t sequence,
                                        std::span<const std::uint16_t> steps);
// A frame of the UART as the message that carries it over CAN. Pre: whole; no sample.
dronecan::PodFrame pod_message(std::span<const std::uint8_t> frame);

struct PodSetpoint {
  std::uint8_t esc = 0;  // 0..3
  bool valid = false;
  std::uint16_t value = 0;
};

struct PodWritten {
  std::uint32_t t_us = 0;  // the pod's clock
  std::span<const std::uint8_t> bytes;
};

class PodLinkReader {
 public:
  explicit PodLinkReader(std::function<void(const PodStatus&)> on_status)
      : on_status_(std::move(on_status)) {}
  void on_setpoint(std::function<void(const PodSetpoint&)> sink) { on_setpoint_ = std::move(sink); }
  void on_written(PodEnd line, std::function<void(const PodWritten&)> sink) {
    (line == PodEnd::gps ? on_gps_written_ : on_radio_written_) = std::move(sink);
  }
  void add(std::uint8_t byte);                  // of the UART
  void add(const dronecan::PodFrame& message);  // of CAN
  void add(const dronecan::PodSetpoint& message);
  std::uint64_t damaged() const { return damaged_; }

 private:
  void frame();
  bool on_frame(std::uint8_t kind, std::span<const std::uint8_t> payload);

  std::function<void(const PodStatus&)> on_status_;
  std::function<void(const PodSetpoint&)> on_setpoint_;
  std::function<void(const PodWritten&)> on_gps_written_, on_radio_written_;
  std::vector<std::uint8_t> bytes_;
  std::uint64_t damaged_ = 0;
};

}  // namespace whirl::io
