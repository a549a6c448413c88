#include "io_bridges/devices/hmc5883l.hpp"

#include <algorithm>
#include <cmath>

namespace whirl::io {
namespace {

// Transcribed from the data sheet's table 2.
enum Address : std::uint8_t {
  CONF_A = 0x00,
  CONF_B = 0x01,
  MODE = 0x02,
  DATA_X_MSB = 0x03,
  DATA_Z_MSB = 0x05,
  DATA_Y_MSB = 0x07,
  DATA_Y_LSB = 0x08,
  STATUS = 0x09,
  ID_A = 0x0A,
  ID_C = 0x0C,
};
constexpr std::uint8_t kLOCK = 0x02, kRDY = 0x01;
constexpr std::uint8_t kContinuous = 0, kSingle = 1, kIdle = 3;

constexpr auto RW = Access::read_write;
constexpr auto RO = Access::read_only;
constexpr RegisterSpec kMap[] = {
    {CONF_A, "CONF_A", RW, 0x10, Depth::modelled}, {CONF_B, "CONF_B", RW, 0x20, Depth::modelled},
    {MODE, "MODE", RW, kSingle, Depth::modelled},  {0x03, "DXRA", RO, 0, Depth::modelled},
    {0x04, "DXRB", RO, 0, Depth::modelled},        {0x05, "DZRA", RO, 0, Depth::modelled},
    {0x06, "DZRB", RO, 0, Depth::modelled},        {0x07, "DYRA", RO, 0, Depth::modelled},
    {0x08, "DYRB", RO, 0, Depth::modelled},        {STATUS, "SR", RO, 0, Depth::modelled},
    {ID_A, "IRA", RO, 'H', Depth::modelled},       {0x0B, "IRB", RO, '4', Depth::modelled},
    {ID_C, "IRC", RO, '3', Depth::modelled},
};
constexpr std::uint8_t kData[3] = {DATA_X_MSB, DATA_Y_MSB, DATA_Z_MSB};  // of x, y, z

constexpr double kRate_Hz[] = {0.75, 1.5, 3.0, 7.5, 15.0, 30.0, 75.0};
constexpr double kCounts_per_Ga[] = {1370, 1090, 820, 660, 440, 390, 330, 230};
constexpr double kStraps_Ga[] = {1.16, 1.16, 1.08};
constexpr double kGa_T = 1e-4;
constexpr int kOverflow_counts = -4096;

constexpr Nanoseconds kAnalog_start_ns = 50'000'000;
constexpr Nanoseconds kMeasurement_ns = 6'000'000;
constexpr Nanoseconds kWriting_ns = 250'000;
constexpr Nanoseconds kPulse_ns = 5'000;

int mode_of(std::uint8_t mode_register) {
  return mode_register & 3;
}

}  // namespace

Hmc5883l::Hmc5883l(EventQueue& queue, const Params& params, Sense sense, Wire* drdy,
                   FaultBook* faults, FindingSink findings)
    : queue_(queue),
      params_(params),
      sense_(std::move(sense)),
      drdy_(drdy),
      faults_(faults),
      registers_(kMap, params.name, std::move(findings)),
      noise_(params.seed, params.name + ".noise"),
      write_begins_(queue, [this] { begin_write(); }),
      data_placed_(queue, [this] { place(); }),
      pulse_end_(queue, [this] { drive_drdy(true, queue_.now()); }),
      supply_(
          queue, faults, params.bus, params.device, [this](Nanoseconds now) { supply(false, now); },
          [this](Nanoseconds now) { supply(true, now); }),
      analog_ready_ns_(queue.now() + kAnalog_start_ns),
      gain_(registers_.peek(CONF_B) >> 5) {
  if (drdy_ != nullptr) driver_ = drdy_->add_driver(params_.name);
  drive_drdy(true, queue_.now());
  set_mode(queue_.now());
}

void Hmc5883l::supply(bool on, Nanoseconds now) {
  powered_ = on;
  registers_.reset();
  for (Event* event : {&write_begins_, &data_placed_, &pulse_end_}) event->cancel();
  drive_drdy(true, now);  // pulled up
  gain_ = registers_.peek(CONF_B) >> 5;
  data_read_ = pointer_ = 0;
  if (!on) return;
  analog_ready_ns_ = now + kAnalog_start_ns;
  set_mode(now);
}

// ---- Measuring

void Hmc5883l::set_mode(Nanoseconds now) {
  write_begins_.cancel();
  data_placed_.cancel();
  const Nanoseconds from = std::max(now, analog_ready_ns_);
  const int mode = mode_of(registers_.peek(MODE));
  if (mode == kSingle) measure_at(from + kMeasurement_ns);
  if (mode != kContinuous) return;
  const double rate_Hz = kRate_Hz[registers_.peek(CONF_A) >> 2 & 7];
  measure_at(from + std::llround(2e9 / rate_Hz));
}

// Data are placed then; their write begins a little earlier.
void Hmc5883l::measure_at(Nanoseconds due) {
  if (const Fault* late = fault(FaultKind::sensor_late, queue_.now())) {
    due += std::max(0LL, std::llround(late->value * 1e9));
  }
  data_placed_.at(due);
  write_begins_.at(due - kWriting_ns);
}

void Hmc5883l::begin_write() {
  if (!locked()) set_status(kRDY, false);
}

void Hmc5883l::place() {
  const Nanoseconds now = queue_.now();
  const std::array<double, 3> field_T = sense_(now);
  const bool frozen = fault(FaultKind::sensor_frozen, now) != nullptr;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int counts = counts_of(axis, field_T[axis], now);
    if (!frozen && !locked()) store(axis, counts);
  }
  gain_ = registers_.peek(CONF_B) >> 5;
  if (!locked()) {
    ++samples_;
    set_status(kRDY, true);
    drive_drdy(false, now);
    pulse_end_.at(now + kPulse_ns);
  }
  if (mode_of(registers_.peek(MODE)) == kSingle) return registers_.poke(MODE, kIdle);
  const double rate_Hz = kRate_Hz[registers_.peek(CONF_A) >> 2 & 7];
  measure_at(now + std::llround(1e9 / rate_Hz));
}

int Hmc5883l::counts_of(std::size_t axis, double field_T, Nanoseconds now) {
  const std::uint8_t conf_a = registers_.peek(CONF_A);
  const double averages = 1 << (conf_a >> 5 & 3);
  const double noise_T = params_.noise_T / std::sqrt(averages) * noise_.normal();
  const int number = static_cast<int>(axis);
  const Fault* offset = fault(FaultKind::sensor_offset, now, number);
  if (offset != nullptr) field_T += offset->value;
  if (fault(FaultKind::sensor_saturated, now, number) != nullptr) return kOverflow_counts;

  const double per_T = kCounts_per_Ga[gain_] / kGa_T;
  const auto overflows = [](long counts) { return counts < -2048 || counts > 2047; };
  const int sign = (conf_a & 3) == 1 ? 1 : (conf_a & 3) == 2 ? -1 : 0;
  const double straps_T = sign * kStraps_Ga[axis] * kGa_T;
  const long converted = std::lround((field_T + straps_T + noise_T) * per_T);
  const long counts = sign == 0 ? converted : std::lround((straps_T + noise_T) * per_T);
  const bool overflow = overflows(converted) || overflows(counts);
  return overflow ? kOverflow_counts : static_cast<int>(counts);
}

void Hmc5883l::store(std::size_t axis, int counts) {
  const std::uint8_t msb = kData[axis];
  registers_.poke(msb, static_cast<std::uint8_t>(counts >> 8 & 0xFF));
  registers_.poke(static_cast<std::uint8_t>(msb + 1), static_cast<std::uint8_t>(counts & 0xFF));
}

void Hmc5883l::drive_drdy(bool high, Nanoseconds now) {
  if (drdy_ != nullptr) drdy_->drive(driver_, high ? Drive::high : Drive::low, now);
}

// ---- Status

bool Hmc5883l::locked() const {
  return (registers_.peek(STATUS) & kLOCK) != 0;
}

void Hmc5883l::set_status(std::uint8_t bit, bool on) {
  const std::uint8_t status = registers_.peek(STATUS);
  registers_.poke(STATUS, static_cast<std::uint8_t>(on ? status | bit : status & ~bit));
}

void Hmc5883l::unlock() {
  data_read_ = 0;
  set_status(kLOCK, false);
}

void Hmc5883l::data_read(std::uint8_t address) {
  data_read_ = static_cast<std::uint8_t>(data_read_ | 1 << (address - DATA_X_MSB));
  set_status(kLOCK, true);
  if (data_read_ == 0x3F) unlock();
}

// ---- Registers

std::uint8_t Hmc5883l::read_register(std::uint8_t address, Nanoseconds now) {
  const std::uint8_t value = registers_.read(address, now);
  if (address == MODE) set_status(kLOCK, true);
  if (address >= DATA_X_MSB && address <= DATA_Y_LSB) data_read(address);
  if (address == ID_A) {
    const Fault* wrong = fault(FaultKind::sensor_wrong_identity, now);
    if (wrong != nullptr) return static_cast<std::uint8_t>(wrong->value);
  }
  return value;
}

// What of a value the register takes; the rest is a finding.
std::uint8_t Hmc5883l::accept(std::uint8_t address, std::uint8_t value, Nanoseconds now) {
  const std::uint8_t before = registers_.peek(address);
  const auto keep = [&](int mask) {
    value = static_cast<std::uint8_t>((value & ~mask) | (before & mask));
  };
  if (address == CONF_A) {
    if ((value & 0x80) != 0) registers_.report(now, "CONF_A bit 7 is reserved");
    keep(0x80);
    if ((value & 0x1C) == 0x1C) {
      registers_.report(now, "DO 7 is reserved: the rate stays");
      keep(0x1C);
    }
    if ((value & 0x03) == 0x03) {
      registers_.report(now, "MS 3 is reserved: the measurement stays");
      keep(0x03);
    }
  }
  if (address == CONF_B) {
    if ((value & 0x1F) != 0) registers_.report(now, "CONF_B bits 4..0 must be 0");
    keep(0x1F);
  }
  if (address == MODE) {
    if ((value & 0xFC) != 0) registers_.report(now, "MODE bits 7..2 (7: HS) are not modelled");
    keep(0xFC);
  }
  return value;
}

void Hmc5883l::write_register(std::uint8_t address, std::uint8_t value, Nanoseconds now) {
  const std::uint8_t before = registers_.peek(address);
  if (!registers_.write(address, accept(address, value, now), now)) return;
  const bool changed = registers_.peek(address) != before;
  if (address == MODE || (address == CONF_A && changed)) unlock();
  const bool continuous = mode_of(registers_.peek(MODE)) == kContinuous;
  if (address == MODE || (address == CONF_A && changed && continuous)) set_mode(now);
}

// Past the data it goes back to them, so that a driver reads the six again without setting it.
void Hmc5883l::advance_pointer() {
  if (pointer_ == DATA_Y_LSB) {
    pointer_ = DATA_X_MSB;
  } else {
    pointer_ = pointer_ >= ID_C ? 0 : static_cast<std::uint8_t>(pointer_ + 1);
  }
}

// ---- I2C

bool Hmc5883l::start(std::uint8_t /*address_7bit*/, bool read, Nanoseconds /*now*/) {
  if (!powered_) return false;
  if (!read) written_ = 0;
  return true;
}

bool Hmc5883l::write(std::uint8_t byte, Nanoseconds now) {
  ++written_;
  if (written_ == 1) {
    pointer_ = byte;
    return true;
  }
  if (written_ == 3)
    registers_.report(now, "several registers in one write: no source says what it does");
  write_register(pointer_, byte, now);
  advance_pointer();
  return true;
}

std::uint8_t Hmc5883l::read(Nanoseconds now) {
  const std::uint8_t value = read_register(pointer_, now);
  advance_pointer();
  return value;
}

}  // namespace whirl::io
