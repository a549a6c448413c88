// Driver for the MEAS MS5611-01BA03 barometer on I2C.
//
//   Contract  step() every 10 ms from a task; job_done() from the bus's interrupt, of its address
//   Output    pressure and temperature by the sheet's compensation of second order, OSR 4096: three
//             pressures, then a temperature, each of a step, so 75 pressures a second
//   Checks    the PROM by its CRC at start; in flight one of its words is read again each second. An
//             ADC of 0 (no conversion, or cut short) is no sample, nor is what lies beyond the sheet's
//             range. Five failures in a row: reset anew
//   Source    MS5611-01BA03 data sheet: commands, PROM, compensation; AN520 for the CRC
#pragma once
#include <array>
#include <cstdint>
#include <tuple>

#include "firmware/drivers/i2c_dialogue.hpp"

namespace fw {

struct BaroSample {
  float pressure_Pa = 0.0f, temperature_degC = 0.0f;
  bool within_range() const {
    return pressure_Pa > 1e3f && pressure_Pa < 120e3f && temperature_degC > -40.0f &&
           temperature_degC < 85.0f;
  }
};

// The PROM's eight words and what follows from them.
class Ms5611Prom {
 public:
  std::array<std::uint16_t, 8> words{};

  // All zero has a right CRC, and is no PROM.
  bool valid() const { return crc() == (words[7] & 0xFu) && words[1] != 0; }
  BaroSample compensate(std::uint32_t d1, std::uint32_t d2) const;

 private:
  std::uint16_t crc() const;
};

inline std::uint16_t Ms5611Prom::crc() const {
  std::uint32_t rest = 0;
  for (unsigned i = 0; i < 16; ++i) {
    const std::uint32_t word = i / 2 == 7 ? words[7] & 0xFF00u : words[i / 2];
    rest ^= i % 2 == 0 ? word >> 8 : word & 0xFFu;
    for (unsigned bit = 0; bit < 8; ++bit) {
      rest = (rest & 0x8000u) != 0 ? rest << 1 ^ 0x3000u : rest << 1;
    }
    rest &= 0xFFFFu;
  }
  return static_cast<std::uint16_t>(rest >> 12);
}

inline BaroSample Ms5611Prom::compensate(std::uint32_t d1, std::uint32_t d2) const {
  const auto c = [this](unsigned i) { return static_cast<std::int64_t>(words[i]); };
  const std::int64_t dt = static_cast<std::int64_t>(d2) - (c(5) << 8);
  std::int64_t temperature = 2000 + (dt * c(6) >> 23);  // 0.01 degC
  std::int64_t offset = (c(2) << 16) + (c(4) * dt >> 7);
  std::int64_t sensitivity = (c(1) << 15) + (c(3) * dt >> 8);
  if (temperature < 2000) {
    const std::int64_t cold = temperature - 2000, frost = temperature + 1500;
    std::int64_t offset2 = 5 * cold * cold >> 1, sensitivity2 = 5 * cold * cold >> 2;
    if (frost < 0) {
      offset2 += 7 * frost * frost;
      sensitivity2 += 11 * frost * frost >> 1;
    }
    temperature -= dt * dt >> 31;
    offset -= offset2;
    sensitivity -= sensitivity2;
  }
  // The sheet cuts what is below a pascal off by a shift of 15.
  const std::int64_t pressure = (static_cast<std::int64_t>(d1) * sensitivity >> 21) - offset;
  return {static_cast<float>(pressure) / 32768.0f, 0.01f * static_cast<float>(temperature)};
}

template <I2cQueue Bus>
class Ms5611 {
 public:
  static constexpr std::uint8_t kAddress = 0x76;

  explicit constexpr Ms5611(Bus& bus) : part_(bus) {}

  void step();
  void job_done(const hal::I2cJob& job, Status status) { part_.job_done(job, status); }

  bool running() const { return phase_ == Phase::run; }
  // True: a new pressure since the last call.
  bool take(BaroSample& out) {
    if (!fresh_) return false;
    fresh_ = false;
    out = sample_;
    return true;
  }
  std::uint32_t failures() const { return failures_; }
  std::uint32_t restarts() const { return restarts_; }

 private:
  enum class Phase : std::uint8_t { reset, settle, prom, run };
  enum class Waits : std::uint8_t { nothing, prom_word, pressure, temperature, check };
  enum Command : std::uint8_t {
    kAdcRead = 0x00,
    kReset = 0x1E,
    kConvertPressure = 0x48,
    kConvertTemperature = 0x58,
    kPromRead = 0xA0
  };
  static constexpr unsigned kCycle = 4, kCheckEvery = 100, kMostFailures = 5;

  void ask(std::uint8_t code, std::uint8_t length, Waits what) {
    if (part_.ask(code, length)) waits_ = what;
  }
  void start_over() {
    ++restarts_;
    phase_ = Phase::reset;
    bad_ = 0;
  }
  void take_answer();
  void take_adc(bool pressure);
  void convert();

  using Dialogue = I2cDialogue<Bus, kAddress, 3>;
  Dialogue part_;
  Phase phase_ = Phase::reset;
  Ms5611Prom prom_;
  unsigned next_word_ = 0, slot_ = 0, steps_ = 0, bad_ = 0;
  std::uint32_t temperature_raw_ = 0, failures_ = 0, restarts_ = 0;
  BaroSample sample_;
  bool fresh_ = false, converting_pressure_ = false, converting_ = false, check_due_ = false;
  Waits waits_ = Waits::nothing;
};

template <I2cQueue Bus>
void Ms5611<Bus>::step() {
  const auto outcome = part_.take();
  if (outcome == Dialogue::Outcome::failed) {
    ++failures_;
    converting_ = false;
    if (++bad_ >= kMostFailures) start_over();
  } else if (outcome == Dialogue::Outcome::answered) {
    take_answer();
  }
  waits_ = Waits::nothing;
  switch (phase_) {
    case Phase::reset:
      if (part_.write(kReset) == Status::ok) phase_ = Phase::settle;
      return;
    case Phase::settle:  // 2.8 ms; a step is 10
      next_word_ = 0;
      phase_ = Phase::prom;
      [[fallthrough]];
    case Phase::prom:
      return ask(static_cast<std::uint8_t>(kPromRead + 2 * next_word_), 2, Waits::prom_word);
    case Phase::run:
      return convert();
  }
}

template <I2cQueue Bus>
void Ms5611<Bus>::take_answer() {
  const auto& answer = part_.answer();
  const auto word = static_cast<std::uint16_t>(answer[0] << 8 | answer[1]);
  switch (waits_) {
    case Waits::prom_word:
      prom_.words[next_word_++] = word;
      if (next_word_ < prom_.words.size()) return;
      if (!prom_.valid()) return start_over();
      bad_ = slot_ = next_word_ = 0;
      temperature_raw_ = 0;
      converting_ = false;
      phase_ = Phase::run;
      return;
    case Waits::check:
      if (word != prom_.words[next_word_]) start_over();
      next_word_ = (next_word_ + 1) % prom_.words.size();
      return;
    case Waits::pressure:
      return take_adc(true);
    case Waits::temperature:
      return take_adc(false);
    case Waits::nothing:
      return;
  }
}

template <I2cQueue Bus>
void Ms5611<Bus>::take_adc(bool pressure) {
  const auto& answer = part_.answer();
  const std::uint32_t raw = static_cast<std::uint32_t>(answer[0]) << 16 |
                            static_cast<std::uint32_t>(answer[1]) << 8 | answer[2];
  const bool known = pressure && temperature_raw_ != 0;
  const BaroSample sample = known ? prom_.compensate(raw, temperature_raw_) : BaroSample{};
  if (raw == 0 || (known && !sample.within_range())) {
    ++failures_;
    if (++bad_ >= kMostFailures) start_over();
    return;
  }
  bad_ = 0;
  if (!pressure) temperature_raw_ = raw;
  if (!known) return;
  sample_ = sample;
  fresh_ = true;
}

// Collects what the last step has started, and starts the next. Before a check of the PROM a step
// starts nothing: the check's answer would be taken for the ADC's.
template <I2cQueue Bus>
void Ms5611<Bus>::convert() {
  if (converting_) {
    ask(kAdcRead, 3, converting_pressure_ ? Waits::pressure : Waits::temperature);
  } else if (check_due_) {
    ask(static_cast<std::uint8_t>(kPromRead + 2 * next_word_), 2, Waits::check);
    check_due_ = false;
  }
  converting_ = false;
  if (++steps_ % kCheckEvery == 0) {
    check_due_ = true;
    return;
  }
  converting_pressure_ = slot_ != 0;
  if (part_.write(converting_pressure_ ? kConvertPressure : kConvertTemperature) != Status::ok)
    return;
  converting_ = true;
  slot_ = (slot_ + 1) % kCycle;
}

}  // namespace fw
