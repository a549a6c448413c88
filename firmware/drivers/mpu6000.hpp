// Driver for the InvenSense MPU-6000 on SPI. Needs a bus that transfers in the background.
//
//   Contract  setup_tick() once per millisecond; data_ready() at the pin's edge and transfer_done() at
//             the end of each transfer, both may come from interrupts
//   Output    the newest burst (acceleration, temperature, rate), as it came off the wire, with its
//             time; decode() scales it. Axes of the sensor: the mounting belongs to the caller
//   Settings  +-2000 deg/s, +-16 g, 188 Hz low-pass, 1 kHz; written, read back, and all of them read
//             again in nine samples while flying: neighbours in one transfer, behind every third sample
//             (at the slow clock: the part's limit is 1 MHz)
//   Silence   10 ms without a sample while running: it is set up anew, for a part that has lost its
//             supply sleeps
//   Source    RM-MPU-6000A-00 rev 4.2 register map; PS-MPU-6000A-00 rev 3.4 for timing and scales
#pragma once
#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <span>
#include <tuple>

#include "firmware/status.hpp"

namespace fw {

template <typename B>
concept BackgroundSpi = requires(B bus, std::span<const std::uint8_t> out, bool fast) {
  { bus.start(out, fast) } -> std::same_as<Status>;
  { bus.received() } -> std::convertible_to<std::span<const std::uint8_t>>;
};

struct ImuReading {
  float acceleration_mps2[3];
  float rate_radps[3];
  float temperature_degC;
};

// The 14 bytes of a burst. Scales: 2048 counts per g, 2000/32768 deg/s per count (the range over
// the rail, which 16.4 rounds), 340 counts per degC around 36.53 degC.
struct ImuBurst {
  std::array<std::uint8_t, 14> bytes{};

  bool operator==(const ImuBurst&) const = default;
  // A rate at a rail is no measurement: integrating it would turn the attitude by anything.
  bool rate_saturated() const {
    for (unsigned at = 8; at < 14; at += 2) {
      const unsigned raw = static_cast<unsigned>(bytes[at]) << 8 | bytes[at + 1];
      if (raw == 0x7FFF || raw == 0x8000) return true;
    }
    return false;
  }
  ImuReading decode() const {
    constexpr float kMps2_per_count = 9.80665f / 2048.0f;
    constexpr float kRadps_per_count = 2000.0f / 32768.0f * 0.017453292520f;
    ImuReading reading{};
    for (unsigned i = 0; i < 3; ++i) {
      reading.acceleration_mps2[i] = kMps2_per_count * word(2 * i);
      reading.rate_radps[i] = kRadps_per_count * word(8 + 2 * i);
    }
    reading.temperature_degC = word(6) / 340.0f + 36.53f;
    return reading;
  }

 private:
  float word(unsigned at) const {
    return static_cast<float>(static_cast<std::int16_t>(bytes[at] << 8 | bytes[at + 1]));
  }
};

template <BackgroundSpi Bus>
class Mpu6000 {
 public:
  explicit constexpr Mpu6000(Bus& bus) : bus_(bus) {}

  bool running() const { return phase_ == Phase::run; }
  Status last_error() const { return error_; }
  std::uint32_t reconfigured() const { return reconfigured_; }

  Status setup_tick();
  bool data_ready(std::uint32_t now_us);  // true: a burst was started
  bool transfer_done();                   // true: a new burst can be taken

  const ImuBurst& burst() const { return burst_; }
  std::uint32_t burst_time_us() const { return burst_time_us_; }  // of its data-ready

 private:
  enum class Phase : std::uint8_t { power_up, reset, reset_paths, identify, write, verify, run };
  enum class Transfer : std::uint8_t { none, setup, burst, check };
  enum Address : std::uint8_t {
    SMPLRT_DIV = 0x19,
    CONFIG = 0x1A,
    GYRO_CONFIG = 0x1B,
    ACCEL_CONFIG = 0x1C,
    INT_PIN_CFG = 0x37,
    INT_ENABLE = 0x38,
    ACCEL_XOUT_H = 0x3B,
    SIGNAL_PATH_RESET = 0x68,
    USER_CTRL = 0x6A,
    PWR_MGMT_1 = 0x6B,
    PWR_MGMT_2 = 0x6C,
    WHO_AM_I = 0x75,
  };
  struct Setting {
    Address address;
    std::uint8_t value;
  };
  static constexpr std::array<Setting, 9> kSettings{{
      {PWR_MGMT_1, 0x01},    // awake, clock from the gyro's PLL
      {USER_CTRL, 0x10},     // I2C off
      {PWR_MGMT_2, 0x00},    // all axes on
      {SMPLRT_DIV, 0x00},    // 1 kHz
      {CONFIG, 0x01},        // 188 Hz
      {GYRO_CONFIG, 0x18},   // +-2000 deg/s
      {ACCEL_CONFIG, 0x18},  // +-16 g
      {INT_PIN_CFG, 0x10},   // active high pulse, cleared by any read
      {INT_ENABLE, 0x01},    // data ready
  }};
  // Registers side by side, which one transfer reads.
  struct Neighbours {
    Address first;
    std::uint8_t count;
  };
  static constexpr std::array<Neighbours, 3> kNeighbours{
      {{SMPLRT_DIV, 4}, {INT_PIN_CFG, 2}, {USER_CTRL, 3}}};
  static constexpr unsigned kSamples_per_check = 3;
  static_assert([] {
    std::size_t checked = 0;
    for (const Setting& s : kSettings) {
      for (const Neighbours& n : kNeighbours) {
        if (s.address >= n.first && s.address < n.first + n.count) ++checked;
      }
    }
    return checked == kSettings.size();
  }());
  static constexpr std::uint8_t kExpectedId = 0x68;
  static constexpr std::uint8_t kRead = 0x80;
  static constexpr unsigned kPowerUp_ms = 30, kSettle_ms = 100;
  static constexpr std::uint32_t kSilent_ms = 10;

  Status read_register(Address address) {
    return start(Transfer::setup,
                 std::array<std::uint8_t, 2>{static_cast<std::uint8_t>(address | kRead), 0});
  }
  Status write_register(Address address, std::uint8_t value) {
    return start(Transfer::setup, std::array<std::uint8_t, 2>{address, value});
  }
  Status start(Transfer kind, std::span<const std::uint8_t> bytes) {
    const Status status = bus_.start(bytes, false);
    if (status == Status::ok) transfer_ = kind;
    return status;
  }
  Status begin(Phase phase) {
    phase_ = phase;
    wait_ms_ = 0;
    next_ = 0;
    asked_ = false;
    silent_ms_ = 0;
    return Status::busy;
  }
  Status fail(Status why) {
    error_ = why;
    std::ignore = begin(Phase::reset);
    return why;
  }
  Status identify();
  Status verify();
  void ask_for_neighbours();
  void check_neighbours(std::span<const std::uint8_t> values);

  Bus& bus_;
  Phase phase_ = Phase::power_up;
  volatile Transfer transfer_ = Transfer::none;
  volatile std::uint32_t silent_ms_ = 0;
  Status error_ = Status::busy;
  bool asked_ = false;
  unsigned wait_ms_ = 0;
  unsigned next_ = 0;
  unsigned neighbours_ = 0, unchecked_ = 0;  // what is checked next, and the samples since the last
  std::uint8_t answer_ = 0;
  std::uint32_t reconfigured_ = 0;
  std::uint32_t started_us_ = 0, burst_time_us_ = 0;
  ImuBurst burst_;
};

template <BackgroundSpi Bus>
Status Mpu6000<Bus>::setup_tick() {
  if (transfer_ != Transfer::none) return Status::busy;
  switch (phase_) {
    case Phase::power_up:  // what is written before the registers are up is lost
      return wait_ms_++ < kPowerUp_ms ? Status::busy : begin(Phase::reset);
    case Phase::reset:
      if (wait_ms_++ == 0) return write_register(PWR_MGMT_1, 0x80);
      return wait_ms_ > kSettle_ms ? begin(Phase::reset_paths) : Status::busy;
    case Phase::reset_paths:
      if (wait_ms_++ == 0) return write_register(SIGNAL_PATH_RESET, 0x07);
      return wait_ms_ > kSettle_ms ? begin(Phase::identify) : Status::busy;
    case Phase::identify:
      return identify();
    case Phase::write:
      if (next_ == kSettings.size()) return begin(Phase::verify);
      if (const Status s = write_register(kSettings[next_].address, kSettings[next_].value);
          s != Status::ok) {
        return s;
      }
      ++next_;
      return Status::busy;
    case Phase::verify:
      return verify();
    case Phase::run:
      break;
  }
  const std::uint32_t silent_ms = silent_ms_ + 1;
  silent_ms_ = silent_ms;
  if (silent_ms <= kSilent_ms) return Status::ok;
  ++reconfigured_;
  error_ = Status::no_answer;
  return begin(Phase::write);
}

template <BackgroundSpi Bus>
Status Mpu6000<Bus>::identify() {
  if (!asked_) {
    asked_ = read_register(WHO_AM_I) == Status::ok;
    return Status::busy;
  }
  if (answer_ != kExpectedId) return fail(Status::wrong_id);
  return begin(Phase::write);
}

template <BackgroundSpi Bus>
Status Mpu6000<Bus>::verify() {
  if (asked_ && answer_ != kSettings[next_].value) return fail(Status::config_lost);
  if (asked_) ++next_;
  if (next_ == kSettings.size()) {
    next_ = 0;
    silent_ms_ = 0;
    error_ = Status::ok;
    phase_ = Phase::run;
    return Status::ok;
  }
  asked_ = read_register(kSettings[next_].address) == Status::ok;
  return Status::busy;
}

template <BackgroundSpi Bus>
bool Mpu6000<Bus>::data_ready(std::uint32_t now_us) {
  if (phase_ != Phase::run || transfer_ != Transfer::none) return false;
  std::array<std::uint8_t, 15> out{};
  out[0] = ACCEL_XOUT_H | kRead;
  if (bus_.start(out, true) != Status::ok) return false;
  transfer_ = Transfer::burst;
  started_us_ = now_us;
  return true;
}

template <BackgroundSpi Bus>
bool Mpu6000<Bus>::transfer_done() {
  const Transfer done = transfer_;
  const std::span<const std::uint8_t> in = bus_.received();
  transfer_ = Transfer::none;
  if (done == Transfer::burst && in.size() == 15) {
    std::copy(in.begin() + 1, in.end(), burst_.bytes.begin());
    burst_time_us_ = started_us_;
    silent_ms_ = 0;
    if (++unchecked_ >= kSamples_per_check) ask_for_neighbours();
    return true;
  }
  if (done == Transfer::check) {
    if (!in.empty()) check_neighbours(in.subspan(1));
  } else if (in.size() == 2) {
    answer_ = in[1];
  }
  return false;
}

// Not an error if it does not start: behind the next sample it does.
template <BackgroundSpi Bus>
void Mpu6000<Bus>::ask_for_neighbours() {
  const Neighbours& asked = kNeighbours[neighbours_];
  std::array<std::uint8_t, 5> out{};
  static_assert(kNeighbours[0].count < out.size());
  out[0] = asked.first | kRead;
  if (start(Transfer::check, std::span(out).first(1u + asked.count)) == Status::ok) unchecked_ = 0;
}

template <BackgroundSpi Bus>
void Mpu6000<Bus>::check_neighbours(std::span<const std::uint8_t> values) {
  const std::uint8_t first = kNeighbours[neighbours_].first;
  for (const Setting& setting : kSettings) {
    const unsigned at = static_cast<unsigned>(setting.address) - first;
    if (at >= values.size() || values[at] == setting.value) continue;
    ++reconfigured_;
    error_ = Status::config_lost;
    std::ignore = begin(Phase::write);
    return;
  }
  neighbours_ = (neighbours_ + 1) % kNeighbours.size();
}

}  // namespace fw
