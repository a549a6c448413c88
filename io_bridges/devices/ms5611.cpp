#include "io_bridges/devices/ms5611.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/check.hpp"

namespace whirl::io {
namespace {

constexpr Nanoseconds kReload_ns = 2'800'000;
constexpr std::uint32_t kMost_counts = 0xFFFFFF;
constexpr std::uint32_t kFastest_sck_Hz = 20'000'000;

struct Oversampling {
  Nanoseconds shortest_ns, longest_ns;
  double rms_Pa, rms_K;
};
constexpr Oversampling kOversampling[] = {
    {480'000, 600'000, 6.5, 0.012},     {950'000, 1'170'000, 4.2, 0.008},
    {1'880'000, 2'280'000, 2.7, 0.005}, {3'720'000, 4'540'000, 1.8, 0.003},
    {7'400'000, 9'040'000, 1.2, 0.002},
};

std::string hex(std::uint8_t byte) {
  char text[8];
  std::snprintf(text, sizeof text, "0x%02X", byte);
  return text;
}

}  // namespace

Ms5611::Ms5611(EventQueue& queue, const Params& params, Sense sense, FaultBook* faults,
               FindingSink findings)
    : queue_(queue),
      params_(params),
      sense_(std::move(sense)),
      faults_(faults),
      findings_(std::move(findings)),
      noise_(params.seed, params.name + ".noise"),
      garbage_(params.seed, params.name + ".garbage"),
      conversion_(queue, [this] { converted(); }),
      supply_(
          queue, faults, params.bus, params.device, [this](Nanoseconds) { supply(false); },
          [this](Nanoseconds) { supply(true); }) {
  WHIRL_CHECK(params.conversion_share >= 0.0 && params.conversion_share <= 1.0,
              params.conversion_share);
}

void Ms5611::report(Nanoseconds now, const std::string& what) {
  findings_.report({now, params_.name, what});
}

// ---- Commands

void Ms5611::command(std::uint8_t byte, Nanoseconds now) {
  answer_.clear();
  if (now < ready_ns_)
    return report(now, "command " + hex(byte) + " during the reload: it is lost");
  if (byte == 0x1E) return reset(now);
  if (byte == 0x00) return read_adc(now);
  if ((byte & 0xF1) == 0xA0) return read_prom(byte >> 1 & 7, now);
  const bool even = (byte & 1) == 0, osr_known = (byte & 0x0F) <= 8;
  if ((byte & 0xF0) == 0x40 && even && osr_known) {
    return convert(Quantity::pressure, byte >> 1 & 7, now);
  }
  if ((byte & 0xF0) == 0x50 && even && osr_known) {
    return convert(Quantity::temperature, byte >> 1 & 7, now);
  }
  report(now, "unknown command " + hex(byte));
}

void Ms5611::supply(bool on) {
  powered_ = on;
  conversion_.cancel();
  answer_.clear();
  waiting_ = false;
  ready_ns_ = 0;
}

void Ms5611::reset(Nanoseconds now) {
  conversion_.cancel();
  waiting_ = false;
  ready_ns_ = now + kReload_ns;
}

void Ms5611::convert(Quantity quantity, std::size_t osr, Nanoseconds now) {
  spoiled_ = conversion_.pending();
  if (spoiled_) report(now, "conversion started during another one: its result is wrong");
  quantity_ = quantity;
  osr_ = osr;
  const Oversampling& row = kOversampling[osr];
  const double span_ns = static_cast<double>(row.longest_ns - row.shortest_ns);
  Nanoseconds takes_ns = row.shortest_ns + std::llround(params_.conversion_share * span_ns);
  if (const Fault* late = fault(FaultKind::sensor_late, now)) {
    takes_ns += std::llround(late->value * 1e9);
  }
  conversion_.at(now + takes_ns);
}

void Ms5611::converted() {
  const Nanoseconds now = queue_.now();
  std::uint32_t& newest = newest_[static_cast<std::size_t>(quantity_)];
  const std::uint32_t fresh = counts(now);
  if (fault(FaultKind::sensor_frozen, now) == nullptr) newest = fresh;
  result_ = spoiled_ ? garbage_.bits() & kMost_counts : newest;
  waiting_ = true;
}

std::uint32_t Ms5611::counts(Nanoseconds now) {
  Truth truth = sense_(now);
  const Oversampling& row = kOversampling[osr_];
  const double noise = params_.noise_scale * noise_.normal();
  const int axis = quantity_ == Quantity::pressure ? 0 : 1;
  const Fault* offset = fault(FaultKind::sensor_offset, now, axis);
  const double added = offset == nullptr ? 0.0 : offset->value;
  if (fault(FaultKind::sensor_saturated, now, axis) != nullptr) return kMost_counts;
  const double exact =
      axis == 0
          ? ms5611::counts_of_pressure(params_.prom, truth.pressure_Pa + added + noise * row.rms_Pa,
                                       truth.temperature_K)
          : ms5611::counts_of_temperature(params_.prom,
                                          truth.temperature_K + added + noise * row.rms_K);
  return static_cast<std::uint32_t>(std::lround(std::clamp(exact, 0.0, double{kMost_counts})));
}

void Ms5611::read_adc(Nanoseconds now) {
  std::uint32_t value = 0;
  if (conversion_.pending()) {
    spoiled_ = true;
    report(now, "ADC read while it converts: it reads 0, and the result to come is wrong");
  } else if (!waiting_) {
    report(now, "ADC read with no result waiting: it reads 0");
  } else {
    value = result_;
  }
  waiting_ = false;
  for (const int shift : {16, 8, 0}) answer_.push_back(static_cast<std::uint8_t>(value >> shift));
}

void Ms5611::read_prom(std::size_t word, Nanoseconds now) {
  if (conversion_.pending()) report(now, "PROM read while it converts");
  std::uint16_t value = params_.prom[word];
  if (word == 7) {
    if (const Fault* wrong = fault(FaultKind::sensor_wrong_identity, now)) {
      value = static_cast<std::uint16_t>(wrong->value);
    }
  }
  answer_ = {static_cast<std::uint8_t>(value >> 8), static_cast<std::uint8_t>(value & 0xFF)};
}

std::uint8_t Ms5611::next_byte() {
  const std::uint8_t byte = answer_.front();
  answer_.pop_front();
  return byte;
}

// ---- SPI

void Ms5611::select(bool /*selected*/, Nanoseconds /*now*/) {
  command_passed_ = false;
  answer_.clear();
}

std::uint8_t Ms5611::transfer(std::uint8_t mosi, std::uint32_t sck_Hz, int mode, Nanoseconds now) {
  if (mode != 0 && mode != 3) {
    report(now, "SPI mode " + std::to_string(mode) + ": the part needs 0 or 3");
    return 0xFF;
  }
  if (sck_Hz > kFastest_sck_Hz) {
    report(now, "SCK of " + std::to_string(sck_Hz / 1000) + " kHz where 20 MHz is the limit");
  }
  if (!powered_) return 0xFF;
  const std::uint8_t idle = busy(now) ? 0x00 : 0xFF;  // SDO is held low until it is done
  if (command_passed_) return answer_.empty() ? idle : next_byte();
  command_passed_ = true;
  command(mosi, now);
  return idle;
}

// ---- I2C

bool Ms5611::answers(std::uint8_t address_7bit) const {
  return address_7bit == params_.i2c_address;
}

bool Ms5611::start(std::uint8_t /*address_7bit*/, bool read, Nanoseconds /*now*/) {
  if (!powered_) return false;
  if (!read) command_passed_ = false;
  return true;
}

bool Ms5611::write(std::uint8_t byte, Nanoseconds now) {
  if (command_passed_) {
    report(now, "a second byte after a command: it is ignored");
    return true;
  }
  command_passed_ = true;
  command(byte, now);
  return true;
}

std::uint8_t Ms5611::read(Nanoseconds /*now*/) {
  return answer_.empty() ? 0x00 : next_byte();
}

}  // namespace whirl::io
