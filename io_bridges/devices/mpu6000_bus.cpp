// The bus side of the MPU-6000: how reads and writes reach its registers, and what they set off.
#include <string>

#include "io_bridges/devices/mpu6000.hpp"
#include "io_bridges/devices/mpu6000_registers.hpp"

namespace whirl::io {
namespace {

using namespace mpu;

constexpr std::uint32_t kSlowSck_Hz = 1'100'000;   // 1 MHz +- 10 %
constexpr std::uint32_t kFastSck_Hz = 22'000'000;  // 20 MHz +- 10 %

bool is_fast_register(std::uint8_t a) {  // readable at 20 MHz
  return (a >= INT_STATUS && a <= EXT_SENS_DATA_23) || (a >= FIFO_COUNT_H && a <= FIFO_R_W);
}

struct Unmodelled {
  std::uint8_t address, mask;
  const char* what;
};
constexpr Unmodelled kUnmodelled[] = {
    {CONFIG, 0x38, "CONFIG.EXT_SYNC_SET is not modelled"},
    {GYRO_CONFIG, 0xE0, "gyro self test is not modelled"},
    {ACCEL_CONFIG, 0xE7, "accelerometer self test and high-pass are not modelled"},
    {FIFO_EN, 0x07, "FIFO of auxiliary slaves is not modelled"},
    {INT_PIN_CFG, 0x0F, "FSYNC, I2C bypass and CLKOUT are not modelled"},
    {INT_ENABLE, 0xEE, "interrupts other than DATA_RDY and FIFO_OFLOW are not modelled"},
    {USER_CTRL, kDMP_EN | kI2C_MST_EN, "DMP and auxiliary I2C master are not modelled"},
    {PWR_MGMT_1, kCYCLE | kTEMP_DIS, "cycle mode and TEMP_DIS are not modelled"},
};

}  // namespace

void Mpu6000::check_unmodelled(std::uint8_t address, std::uint8_t value, Nanoseconds now) {
  for (const Unmodelled& u : kUnmodelled) {
    if (u.address == address && (value & u.mask) != 0) registers_.report(now, u.what);
  }
  if (address == CONFIG && (value & 7) == 7) registers_.report(now, "DLPF_CFG 7 is reserved");
  if (address == PWR_MGMT_1 && (value & kCLKSEL) > 3) {
    registers_.report(now, "CLKSEL 4..7: there is no external clock here, sampling stops");
  }
}

// ---- Registers

std::uint8_t Mpu6000::next_address(std::uint8_t address) const {
  return address == FIFO_R_W ? address : static_cast<std::uint8_t>((address + 1) & 0x7F);
}

std::uint8_t Mpu6000::read_register(std::uint8_t address, Nanoseconds now) {
  if (now < ready_ns_) {  // DEVICE_RESET reads back as set until it is done
    const bool resetting = address == PWR_MGMT_1 && ready_ns_ > params_.register_start_ns;
    return resetting ? kDEVICE_RESET : 0;
  }
  if (address == FIFO_COUNT_H) {  // reading H latches both
    registers_.poke(FIFO_COUNT_H, static_cast<std::uint8_t>(fifo_.size() >> 8));
    registers_.poke(FIFO_COUNT_L, static_cast<std::uint8_t>(fifo_.size() & 0xFF));
  }
  std::uint8_t value = address == FIFO_R_W ? read_fifo(now) : registers_.read(address, now);
  if (address == WHO_AM_I) {
    const Fault* wrong = fault(FaultKind::sensor_wrong_identity, now);
    if (wrong != nullptr) value = static_cast<std::uint8_t>(wrong->value);
  }
  const bool any_read = (registers_.peek(INT_PIN_CFG) & kINT_RD_CLEAR) != 0;
  if (address == INT_STATUS || any_read) clear_interrupt(now);
  return value;
}

bool Mpu6000::fifo_reachable(Nanoseconds now) {
  if ((registers_.peek(USER_CTRL) & kFIFO_ENABLE) != 0) return true;
  registers_.report(now, "FIFO_R_W while USER_CTRL.FIFO_EN is 0: no byte passes");
  return false;
}

std::uint8_t Mpu6000::read_fifo(Nanoseconds now) {
  return fifo_reachable(now) ? pop_fifo() : fifo_last_;
}

void Mpu6000::write_fifo(std::uint8_t value, Nanoseconds now) {
  if (fifo_reachable(now)) push_fifo(value);
}

void Mpu6000::write_register(std::uint8_t address, std::uint8_t value, Nanoseconds now) {
  if (now < ready_ns_) {
    registers_.report(now, "written while starting up: the write is lost");
    return;
  }
  const std::uint8_t before = registers_.peek(address);
  if (address == FIFO_R_W) return write_fifo(value, now);
  if (!registers_.write(address, value, now)) return;
  check_unmodelled(address, value, now);
  act_on_write(address, before, value, now);
}

void Mpu6000::act_on_write(std::uint8_t address, std::uint8_t before, std::uint8_t value,
                           Nanoseconds now) {
  switch (address) {
    case PWR_MGMT_1: {
      if ((value & kDEVICE_RESET) != 0) return reset(now);
      const bool woken = (before & kSLEEP) != 0 && (value & kSLEEP) == 0;
      const std::uint8_t clock = kSLEEP | kCLKSEL;
      if ((before & clock) != (value & clock))
        restart_clock(woken ? now + params_.gyro_start_ns : now);
      break;
    }
    case SMPLRT_DIV:
    case CONFIG: {
      if (clock_ns_ == kNever || value == before) break;
      if (address == CONFIG) set_filters();
      const std::int64_t whole = (ticks_ + ticks_per_sample() + 7) / 8 * 8;
      next_sample_ = ticks_per_sample() % 8 == 0 ? whole : ticks_ + ticks_per_sample();
      sample_due_.at(time_of_tick(next_sample_));
      break;
    }
    case SIGNAL_PATH_RESET:
      settled_ = false;
      break;
    case INT_PIN_CFG:
      drive_interrupt(false, now);
      break;
    case USER_CTRL: {
      if ((value & kFIFO_RESET) != 0) fifo_.clear();
      if ((value & kSIG_COND_RESET) != 0) {
        internal_.fill(0);
        settled_ = false;
        pending_ = true;
      }
      const int self_clearing = kDMP_RESET | kFIFO_RESET | kI2C_MST_RESET | kSIG_COND_RESET;
      registers_.poke(USER_CTRL, static_cast<std::uint8_t>(value & ~self_clearing));
      break;
    }
    default:
      break;
  }
}

// ---- SPI

void Mpu6000::select(bool selected, Nanoseconds /*now*/) {
  selected_ = selected;
  command_.reset();
  if (selected) begin_access();
  if (!selected) end_access();
}

void Mpu6000::check_clock(std::uint32_t sck_Hz, Nanoseconds now) {
  const bool fast = (*command_ & 0x80) != 0 && is_fast_register(address_);
  if (sck_Hz <= (fast ? kFastSck_Hz : kSlowSck_Hz)) return;
  registers_.report(now, "SCK of " + std::to_string(sck_Hz / 1000) + " kHz where " +
                             (fast ? "20 MHz" : "1 MHz") + " is the limit");
}

std::uint8_t Mpu6000::transfer(std::uint8_t mosi, std::uint32_t sck_Hz, int mode, Nanoseconds now) {
  if (!selected_ || !powered_) return 0xFF;
  if (mode != 0 && mode != 3) {
    registers_.report(now, "SPI mode " + std::to_string(mode) + ": the part needs 0 or 3");
    return 0xFF;
  }
  if (!command_) {
    command_ = mosi;
    address_ = mosi & 0x7F;
    return 0x00;
  }
  check_clock(sck_Hz, now);
  const std::uint8_t address = address_;
  address_ = next_address(address_);
  if ((*command_ & 0x80) != 0) return read_register(address, now);
  write_register(address, mosi, now);
  return 0x00;
}

// ---- I2C

bool Mpu6000::answers(std::uint8_t address_7bit) const {
  return address_7bit == params_.i2c_address && (registers_.peek(USER_CTRL) & kI2C_IF_DIS) == 0;
}

bool Mpu6000::start(std::uint8_t /*address_7bit*/, bool read, Nanoseconds now) {
  if (now < ready_ns_ || !powered_) return false;
  begin_access();
  if (!read) pointer_set_ = false;
  return true;
}

bool Mpu6000::write(std::uint8_t byte, Nanoseconds now) {
  if (!pointer_set_) {
    pointer_set_ = true;
    address_ = byte & 0x7F;
    return true;
  }
  const std::uint8_t address = address_;
  address_ = next_address(address_);
  write_register(address, byte, now);
  return true;
}

std::uint8_t Mpu6000::read(Nanoseconds now) {
  const std::uint8_t address = address_;
  address_ = next_address(address_);
  return read_register(address, now);
}

void Mpu6000::stop(Nanoseconds /*now*/) {
  end_access();
}

}  // namespace whirl::io
