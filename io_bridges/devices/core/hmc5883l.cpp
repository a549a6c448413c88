#include "io_bridges/devices/core/hmc5883l.hpp"

#include <algorithm>

namespace whirl::core {
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

constexpr RegisterMap build_map() {
  RegisterMap map{};
  map[CONF_A] = {"CONF_A", RW, 0x10, Depth::modelled};
  map[CONF_B] = {"CONF_B", RW, 0x20, Depth::modelled};
  map[MODE] = {"MODE", RW, kSingle, Depth::modelled};
  constexpr const char* kNames[] = {"DXRA", "DXRB", "DZRA", "DZRB", "DYRA",
                                    "DYRB", "SR",   "IRA",  "IRB",  "IRC"};
  for (std::size_t i = 0; i < std::size(kNames); ++i) {
    map[DATA_X_MSB + i] = {kNames[i], RO, 0, Depth::modelled};
  }
  map[ID_A].reset = 'H';
  map[ID_A + 1].reset = '4';
  map[ID_C].reset = '3';
  return map;
}

constexpr std::uint8_t kData[3] = {DATA_X_MSB, DATA_Y_MSB, DATA_Z_MSB};  // of x, y, z

// By DO, 0.75 to 75 Hz: one and two periods, each to the nearest nanosecond.
constexpr auto kPeriods_ns = [] {
  std::array<std::array<Nanoseconds, 2>, 7> table{};
  constexpr std::int64_t kQuarter_Hz[] = {3, 6, 12, 30, 60, 120, 300};
  for (std::size_t rate = 0; rate < table.size(); ++rate) {
    for (int n : {1, 2}) {
      table[rate][static_cast<std::size_t>(n - 1)] =
          (4'000'000'000 * n + kQuarter_Hz[rate] / 2) / kQuarter_Hz[rate];
    }
  }
  return table;
}();

constexpr Nanoseconds kAnalog_start_ns = 50'000'000;
constexpr Nanoseconds kMeasurement_ns = 6'000'000;
constexpr Nanoseconds kPulse_ns = 5'000;

int mode_of(std::uint8_t mode_register) {
  return mode_register & 3;
}

}  // namespace

constinit const RegisterMap Hmc5883l::kMap = build_map();

void Hmc5883l::supply(bool on, Nanoseconds now) {
  powered_ = on;
  registers_.reset();
  board_.data_due(kNever);
  board_.pulse_ends_at(kNever);
  board_.drdy_pin(true, now);  // pulled up
  gain_ = registers_.peek(CONF_B) >> 5;
  data_read_ = pointer_ = 0;
  if (!on) return;
  analog_ready_ns_ = now + kAnalog_start_ns;
  set_mode(now);
}

// ---- Measuring

void Hmc5883l::set_mode(Nanoseconds now) {
  board_.data_due(kNever);
  const Nanoseconds from = std::max(now, analog_ready_ns_);
  const int mode = mode_of(registers_.peek(MODE));
  if (mode == kSingle) board_.data_due(from + kMeasurement_ns);
  if (mode == kContinuous) board_.data_due(from + kPeriods_ns[rate()][1]);
}

void Hmc5883l::write_begins() {
  if (!locked()) set_status(kRDY, false);
}

bool Hmc5883l::place(const std::array<std::int16_t, 3>& counts, bool frozen, Nanoseconds now) {
  const bool taken = !locked();
  for (std::size_t axis = 0; axis < 3 && taken && !frozen; ++axis) {
    const auto bits = static_cast<std::uint16_t>(counts[axis]);
    registers_.poke(kData[axis], static_cast<std::uint8_t>(bits >> 8));
    registers_.poke(static_cast<std::uint8_t>(kData[axis] + 1),
                    static_cast<std::uint8_t>(bits & 0xFF));
  }
  gain_ = registers_.peek(CONF_B) >> 5;
  if (taken) {
    set_status(kRDY, true);
    board_.drdy_pin(false, now);
    board_.pulse_ends_at(now + kPulse_ns);
  }
  if (mode_of(registers_.peek(MODE)) == kSingle) {
    registers_.poke(MODE, kIdle);
  } else {
    board_.data_due(now + kPeriods_ns[rate()][0]);
  }
  return taken;
}

int Hmc5883l::bias() const {
  const int measurement = registers_.peek(CONF_A) & 3;
  return measurement == 1 ? 1 : measurement == 2 ? -1 : 0;
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
  const std::uint8_t value = registers_.read(address, board_, now);
  if (address == MODE) set_status(kLOCK, true);
  if (address >= DATA_X_MSB && address <= DATA_Y_LSB) data_read(address);
  return address == ID_A ? board_.identity(value, now) : value;
}

namespace {

constexpr std::uint8_t keep(std::uint8_t value, std::uint8_t before, int mask) {
  return static_cast<std::uint8_t>((value & ~mask) | (before & mask));
}

}  // namespace

std::uint8_t Hmc5883l::accept_conf_a(std::uint8_t value, std::uint8_t before, Nanoseconds now) {
  if ((value & 0x80) != 0) board_.odd(Oddity::conf_a_bit_7, value, now);
  value = keep(value, before, 0x80);
  if ((value & 0x1C) == 0x1C) {
    board_.odd(Oddity::rate_reserved, value, now);
    value = keep(value, before, 0x1C);
  }
  if ((value & 0x03) == 0x03) {
    board_.odd(Oddity::bias_reserved, value, now);
    value = keep(value, before, 0x03);
  }
  return value;
}

// What of a value the register takes; the rest is an oddity.
std::uint8_t Hmc5883l::accept(std::uint8_t address, std::uint8_t value, Nanoseconds now) {
  if (address > MODE) return value;
  const std::uint8_t before = registers_.peek(address);
  if (address == CONF_A) return accept_conf_a(value, before, now);
  const std::uint8_t fixed = address == CONF_B ? 0x1F : 0xFC;
  if ((value & fixed) != 0) {
    board_.odd(address == CONF_B ? Oddity::conf_b_low_bits : Oddity::mode_high_bits, value, now);
  }
  return keep(value, before, fixed);
}

void Hmc5883l::write_register(std::uint8_t address, std::uint8_t value, Nanoseconds now) {
  const std::uint8_t before = address < kRegisters ? registers_.peek(address) : 0;
  if (!registers_.write(address, accept(address, value, now), board_, now)) return;
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

bool Hmc5883l::start(bool read) {
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
  if (written_ == 3) board_.odd(Oddity::several_registers, pointer_, now);
  write_register(pointer_, byte, now);
  advance_pointer();
  return true;
}

std::uint8_t Hmc5883l::read(Nanoseconds now) {
  const std::uint8_t value = read_register(pointer_, now);
  advance_pointer();
  return value;
}

}  // namespace whirl::core
