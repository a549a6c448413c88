#include "io_bridges/devices/core/mpu6000.hpp"

namespace whirl::core {

using namespace mpu;

namespace {

constexpr std::int64_t kSlowRatio = 8;  // 8 kHz to 1 kHz
constexpr Nanoseconds kPulse_ns = 50'000;

constexpr std::uint8_t high_byte(std::size_t value) {
  return static_cast<std::uint8_t>(value >> 8 & 0xFF);
}
constexpr std::uint8_t low_byte(std::size_t value) {
  return static_cast<std::uint8_t>(value & 0xFF);
}

// FIFO_EN's bit for each byte of a sample.
constexpr std::uint8_t fifo_gate(std::size_t i) {
  if (i < 6) return kACCEL_FIFO_EN;
  if (i < 8) return kTEMP_FIFO_EN;
  return i < 10 ? kXG_FIFO_EN : i < 12 ? kYG_FIFO_EN : kZG_FIFO_EN;
}

}  // namespace

// ---- Power and clock

void Mpu6000::reset(Nanoseconds now) {
  registers_.reset();
  registers_.poke(PRODUCT_ID, params_.product_id);
  ready_ns_ = now + params_.register_start_ns;
  clocked_ = false;
  internal_.fill(0);
  pending_ = false;
  clear_fifo();
  board_.was_reset();
  drive_interrupt(false, now);
}

bool Mpu6000::gyro_fast() const {
  return dlpf() == 0 || dlpf() == 7;  // 7 is reserved and taken as 0
}

std::int64_t Mpu6000::ticks_per_sample() const {
  return (gyro_fast() ? 1 : kSlowRatio) * (1 + registers_.peek(SMPLRT_DIV));
}

// Tick 0 is due at `now` and gives the first sample; without a clock there is none.
void Mpu6000::restart_clock(Nanoseconds now) {
  const std::uint8_t power = registers_.peek(PWR_MGMT_1);
  clocked_ = (power & kSLEEP) == 0 && (power & kCLKSEL) <= 3;
  board_.clock_restarts(clocked_ ? now : kNever);
}

// ---- Samples

void Mpu6000::store(const std::array<std::int16_t, 7>& counts) {
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto bits = static_cast<std::uint16_t>(counts[i]);
    internal_[2 * i] = high_byte(bits);
    internal_[2 * i + 1] = low_byte(bits);
  }
  pending_ = true;
  if (!busy_) end_access();
}

void Mpu6000::end_access() {
  busy_ = false;
  if (!pending_) return;
  pending_ = false;
  for (std::size_t i = 0; i < internal_.size(); ++i) {
    registers_.poke(static_cast<std::uint8_t>(ACCEL_XOUT_H + i), internal_[i]);
  }
}

void Mpu6000::data_ready(Nanoseconds now) {
  fill_fifo(now);
  raise_interrupt(kDATA_RDY, now);
}

// ---- FIFO

void Mpu6000::fill_fifo(Nanoseconds now) {
  if ((registers_.peek(USER_CTRL) & kFIFO_ENABLE) == 0) return;
  const std::uint8_t enabled = registers_.peek(FIFO_EN);
  for (std::size_t i = 0; i < internal_.size(); ++i) {  // in register order, low to high
    if ((enabled & fifo_gate(i)) != 0) push_fifo(internal_[i], now);
  }
}

void Mpu6000::push_fifo(std::uint8_t byte, Nanoseconds now) {
  if (fifo_count_ == kFifoBytes) {
    fifo_first_ = (fifo_first_ + 1) % kFifoBytes;
    --fifo_count_;
    raise_interrupt(kFIFO_OFLOW, now);
  }
  fifo_[(fifo_first_ + fifo_count_++) % kFifoBytes] = byte;
  show_fifo();
}

std::uint8_t Mpu6000::pop_fifo() {
  if (fifo_count_ == 0) return fifo_last_;
  fifo_last_ = fifo_[fifo_first_];
  fifo_first_ = (fifo_first_ + 1) % kFifoBytes;
  --fifo_count_;
  show_fifo();
  return fifo_last_;
}

void Mpu6000::clear_fifo() {
  fifo_first_ = fifo_count_ = 0;
  show_fifo();
}

// For image(): FIFO_COUNT_L follows when H is read, which latches both.
void Mpu6000::show_fifo() {
  const bool in_reach = (registers_.peek(USER_CTRL) & kFIFO_ENABLE) != 0 && fifo_count_ > 0;
  registers_.poke(FIFO_R_W, in_reach ? fifo_[fifo_first_] : fifo_last_);
  registers_.poke(FIFO_COUNT_H, high_byte(fifo_count_));
}

bool Mpu6000::fifo_reachable(Nanoseconds now) {
  if ((registers_.peek(USER_CTRL) & kFIFO_ENABLE) != 0) return true;
  board_.odd(Oddity::fifo_disabled, 0, now);
  return false;
}

// ---- Interrupt

void Mpu6000::raise_interrupt(std::uint8_t status_bit, Nanoseconds now) {
  registers_.poke(INT_STATUS, registers_.peek(INT_STATUS) | status_bit);
  if ((registers_.peek(INT_ENABLE) & status_bit) == 0) return;
  drive_interrupt(true, now);
  if ((registers_.peek(INT_PIN_CFG) & kLATCH_INT_EN) == 0) board_.pulse_ends_at(now + kPulse_ns);
}

void Mpu6000::clear_interrupt(Nanoseconds now) {
  registers_.poke(INT_STATUS, 0);
  if ((registers_.peek(INT_PIN_CFG) & kLATCH_INT_EN) != 0) drive_interrupt(false, now);
}

void Mpu6000::drive_interrupt(bool active, Nanoseconds now) {
  const std::uint8_t pin = registers_.peek(INT_PIN_CFG);
  const bool high = active != ((pin & kINT_LEVEL) != 0);
  const Pin up = (pin & kINT_OPEN) != 0 ? Pin::open : Pin::high;
  board_.interrupt_pin(high ? up : Pin::low, now);
}

// ---- Registers

std::uint8_t Mpu6000::next_address(std::uint8_t address) {
  return address == FIFO_R_W ? address : static_cast<std::uint8_t>((address + 1) & 0x7F);
}

std::uint8_t Mpu6000::step_address() {
  const std::uint8_t address = address_;
  address_ = next_address(address_);
  return address;
}

const std::uint8_t* Mpu6000::image(Nanoseconds now) const {
  static constexpr auto kResetting = [] {  // DEVICE_RESET reads back as set until it is done
    std::array<std::uint8_t, kRegisters> page{};
    page[PWR_MGMT_1] = kDEVICE_RESET;
    return page;
  }();
  static constexpr std::array<std::uint8_t, kRegisters> kDead{};
  if (now >= ready_ns_) return registers_.image();
  return ready_ns_ > params_.register_start_ns ? kResetting.data() : kDead.data();
}

std::uint8_t Mpu6000::read_register(std::uint8_t address, Nanoseconds now) {
  if (now < ready_ns_) return image(now)[address & 0x7F];
  if (address == FIFO_COUNT_H) {
    registers_.poke(FIFO_COUNT_H, high_byte(fifo_count_));
    registers_.poke(FIFO_COUNT_L, low_byte(fifo_count_));
  }
  std::uint8_t value = 0;
  if (address == FIFO_R_W) {
    value = fifo_reachable(now) ? pop_fifo() : fifo_last_;
  } else {
    value = registers_.read(address, board_, now);
  }
  if (address == WHO_AM_I) value = board_.identity(value, now);
  const bool any_read = (registers_.peek(INT_PIN_CFG) & kINT_RD_CLEAR) != 0;
  if (address == INT_STATUS || any_read) clear_interrupt(now);
  return value;
}

// ---- SPI

void Mpu6000::select(bool selected) {
  selected_ = selected;
  command_passed_ = false;
  if (selected) begin_access();
  if (!selected) end_access();
}

std::uint8_t Mpu6000::transfer(std::uint8_t mosi, std::uint32_t sck_Hz, int mode, Nanoseconds now) {
  if (!selected_ || !powered_) return 0xFF;
  if (mode != 0 && mode != 3) {
    board_.odd(Oddity::spi_mode, static_cast<std::uint32_t>(mode), now);
    return 0xFF;
  }
  if (!command_passed_) {
    command_passed_ = true;
    command_ = mosi;
    address_ = mosi & 0x7F;
    return 0x00;
  }
  check_clock(sck_Hz, now);
  const std::uint8_t address = step_address();
  if ((command_ & 0x80) != 0) return read_register(address, now);
  write_register(address, mosi, now);
  return 0x00;
}

// ---- I2C

bool Mpu6000::answers(std::uint8_t address_7bit) const {
  return address_7bit == params_.i2c_address && (registers_.peek(USER_CTRL) & kI2C_IF_DIS) == 0;
}

bool Mpu6000::start(bool read, Nanoseconds now) {
  if (now < ready_ns_ || !powered_) return false;
  begin_access();
  if (!read) pointer_set_ = false;
  return true;
}

bool Mpu6000::write(std::uint8_t byte, Nanoseconds now) {
  if (pointer_set_) {
    write_register(step_address(), byte, now);
  } else {
    pointer_set_ = true;
    address_ = byte & 0x7F;
  }
  return true;
}

std::uint8_t Mpu6000::read(Nanoseconds now) {
  return read_register(step_address(), now);
}

}  // namespace whirl::core
