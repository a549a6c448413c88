// Driver for the Honeywell HMC5883L magnetometer on I2C.
//
//   Contract  step() every 10 ms from a task; job_done() from the bus's interrupt, of its address
//   Output    the field along the sensor's axes: the mounting belongs to the caller
//   Settings  75 Hz, one measurement each, +-1.3 Ga, continuous; written, and two of them read back
//             every 100 ms while running. MODE is not read: reading it would lock the data
//   Checks    identity at start; settings that were lost, and data that stay the same for 0.3 s, have
//             everything written anew; an axis that overflowed (-4096) is no sample; five transactions
//             that failed in a row: from the identity on
//   Source    HMC5883L data sheet: registers, order X Z Y, gains, LOCK; the pointer returns to the
//             first data byte by itself
#pragma once
#include <array>
#include <cstdint>

#include "firmware/drivers/i2c_dialogue.hpp"

namespace fw {

struct MagSample {
  float field_uT[3] = {};
};

template <I2cQueue Bus>
class Hmc5883l {
 public:
  static constexpr std::uint8_t kAddress = 0x1E;

  explicit constexpr Hmc5883l(Bus& bus) : part_(bus) {}

  void step();
  void job_done(const hal::I2cJob& job, Status status) { part_.job_done(job, status); }

  bool running() const { return phase_ == Phase::run; }
  // True: a new measurement since the last call.
  bool take(MagSample& out) {
    if (!fresh_) return false;
    fresh_ = false;
    out = sample_;
    return true;
  }
  std::uint32_t failures() const { return failures_; }
  std::uint32_t reconfigured() const { return reconfigured_; }

 private:
  enum class Phase : std::uint8_t { power_up, identify, write, run };
  enum class Waits : std::uint8_t { nothing, identity, data, settings };
  enum Address : std::uint8_t {
    CONF_A = 0x00,
    CONF_B = 0x01,
    MODE = 0x02,
    DATA_X = 0x03,
    ID_A = 0x0A
  };
  static constexpr std::uint8_t kRate75Hz = 6 << 2, kGain1_3Ga = 1 << 5, kContinuous = 0;
  static constexpr float kMicrotesla_per_count = 100.0f / 1090.0f;
  static constexpr std::int16_t kOverflow = -4096;
  static constexpr unsigned kPowerUp_steps = 10, kCheckEvery = 10, kFrozen = 30, kMostFailures = 5;

  void ask(Address from, std::uint8_t length, Waits what) {
    if (part_.ask(from, length)) waits_ = what;
  }
  void write_settings() {
    // One by one: the sheet does not say what a longer write does.
    constexpr std::uint8_t kSettings[][2] = {
        {CONF_A, kRate75Hz}, {CONF_B, kGain1_3Ga}, {MODE, kContinuous}};
    for (const auto& [address, value] : kSettings) {
      if (part_.write(address, value) != Status::ok) return;
    }
    phase_ = Phase::run;
    same_ = 0;
    skip_ = 2;  // what is in the registers now was measured with other settings
  }
  void lose_settings() {
    ++reconfigured_;
    phase_ = Phase::write;
  }
  void take_answer();
  void take_data();

  using Dialogue = I2cDialogue<Bus, kAddress, 6>;
  Dialogue part_;
  Phase phase_ = Phase::power_up;
  unsigned steps_ = 0, bad_ = 0, same_ = 0, skip_ = 0;
  std::uint32_t failures_ = 0, reconfigured_ = 0;
  MagSample sample_;
  bool fresh_ = false;
  std::array<std::uint8_t, 6> last_{};
  Waits waits_ = Waits::nothing;
};

template <I2cQueue Bus>
void Hmc5883l<Bus>::step() {
  const auto outcome = part_.take();
  if (outcome == Dialogue::Outcome::failed) {
    ++failures_;
    if (++bad_ >= kMostFailures) {
      bad_ = 0;
      phase_ = Phase::identify;
    }
  } else if (outcome == Dialogue::Outcome::answered) {
    bad_ = 0;
    take_answer();
  }
  waits_ = Waits::nothing;
  ++steps_;
  switch (phase_) {
    case Phase::power_up:
      if (steps_ >= kPowerUp_steps) phase_ = Phase::identify;
      return;
    case Phase::identify:
      return ask(ID_A, 3, Waits::identity);
    case Phase::write:
      return write_settings();
    case Phase::run:
      if (steps_ % kCheckEvery == 0) return ask(CONF_A, 2, Waits::settings);
      return ask(DATA_X, 6, Waits::data);
  }
}

template <I2cQueue Bus>
void Hmc5883l<Bus>::take_answer() {
  const auto& answer = part_.answer();
  switch (waits_) {
    case Waits::identity:
      if (answer[0] == 'H' && answer[1] == '4' && answer[2] == '3') {
        phase_ = Phase::write;
      } else {
        ++failures_;
      }
      return;
    case Waits::settings:
      if (answer[0] != kRate75Hz || answer[1] != kGain1_3Ga) lose_settings();
      return;
    case Waits::data:
      return take_data();
    case Waits::nothing:
      return;
  }
}

template <I2cQueue Bus>
void Hmc5883l<Bus>::take_data() {
  if (part_.answer() == last_) {  // read faster than it measures, or it does not measure any more
    if (++same_ >= kFrozen) lose_settings();
    return;
  }
  last_ = part_.answer();
  same_ = 0;
  if (skip_ > 0) {
    --skip_;
    return;
  }
  const auto& answer = part_.answer();
  std::array<std::int16_t, 3> counts{};
  for (unsigned i = 0; i < 3; ++i) {
    counts[i] = static_cast<std::int16_t>(answer[2 * i] << 8 | answer[2 * i + 1]);
    if (counts[i] == kOverflow) return;
  }
  sample_ = {{kMicrotesla_per_count * counts[0], kMicrotesla_per_count * counts[2],
              kMicrotesla_per_count * counts[1]}};
  fresh_ = true;
}

}  // namespace fw
