// What a write to the MPU-6000's registers sets off, and what of it no model here does.
#include "io_bridges/devices/core/mpu6000.hpp"

namespace whirl::core {

using namespace mpu;

namespace {

constexpr std::uint32_t kSlowSck_Hz = 1'100'000;   // 1 MHz +- 10 %
constexpr std::uint32_t kFastSck_Hz = 22'000'000;  // 20 MHz +- 10 %

constexpr bool is_fast_register(std::uint8_t a) {  // readable at 20 MHz
  return (a >= INT_STATUS && a <= EXT_SENS_DATA_23) || (a >= FIFO_COUNT_H && a <= FIFO_R_W);
}

struct Unmodelled {
  std::uint8_t address, mask;
  Oddity what;
};
constexpr Unmodelled kUnmodelled[] = {
    {CONFIG, 0x38, Oddity::ext_sync_set},
    {GYRO_CONFIG, 0xE0, Oddity::gyro_self_test},
    {ACCEL_CONFIG, 0xE7, Oddity::accel_self_test},
    {FIFO_EN, 0x07, Oddity::fifo_of_slaves},
    {INT_PIN_CFG, 0x0F, Oddity::pin_functions},
    {INT_ENABLE, 0xEE, Oddity::other_interrupts},
    {USER_CTRL, kDMP_EN | kI2C_MST_EN, Oddity::dmp_or_i2c_master},
    {PWR_MGMT_1, kCYCLE | kTEMP_DIS, Oddity::cycle_or_temp_dis},
};

}  // namespace

void Mpu6000::check_unmodelled(std::uint8_t address, std::uint8_t value, Nanoseconds now) {
  for (const Unmodelled& u : kUnmodelled) {
    if (u.address == address && (value & u.mask) != 0) board_.odd(u.what, address, now);
  }
  if (address == CONFIG && (value & 7) == 7) board_.odd(Oddity::dlpf_reserved, address, now);
  if (address == PWR_MGMT_1 && (value & kCLKSEL) > 3) {
    board_.odd(Oddity::external_clock, address, now);
  }
}

void Mpu6000::check_clock(std::uint32_t sck_Hz, Nanoseconds now) {
  const bool fast = (command_ & 0x80) != 0 && is_fast_register(address_);
  if (sck_Hz <= (fast ? kFastSck_Hz : kSlowSck_Hz)) return;
  board_.odd(fast ? Oddity::sck_over_20_MHz : Oddity::sck_over_1_MHz, sck_Hz / 1000, now);
}

void Mpu6000::write_register(std::uint8_t address, std::uint8_t value, Nanoseconds now) {
  if (now < ready_ns_) return board_.odd(Oddity::starting_up_write, address, now);
  const std::uint8_t before = registers_.peek(address);
  if (address == FIFO_R_W) {
    if (fifo_reachable(now)) push_fifo(value, now);
    return;
  }
  if (!registers_.write(address, value, board_, now)) return;
  check_unmodelled(address, value, now);
  act_on_write(address, before, value, now);
}

void Mpu6000::act_on_write(std::uint8_t address, std::uint8_t before, std::uint8_t value,
                           Nanoseconds now) {
  switch (address) {
    case PWR_MGMT_1:
      return act_on_power(before, value, now);
    case SMPLRT_DIV:
    case CONFIG:
      if (!clocked_ || value == before) return;
      if (address == CONFIG) board_.filters_changed();
      return board_.sample_rate_changed();
    case SIGNAL_PATH_RESET:
      return board_.filters_unsettled();
    case INT_PIN_CFG:
      return drive_interrupt(false, now);
    case USER_CTRL:
      return act_on_user_control(value);
    default:
      return;
  }
}

void Mpu6000::act_on_power(std::uint8_t before, std::uint8_t value, Nanoseconds now) {
  if ((value & kDEVICE_RESET) != 0) return reset(now);
  const bool woken = (before & kSLEEP) != 0 && (value & kSLEEP) == 0;
  const std::uint8_t clock = kSLEEP | kCLKSEL;
  if ((before & clock) == (value & clock)) return;
  restart_clock(woken ? now + params_.gyro_start_ns : now);
}

void Mpu6000::act_on_user_control(std::uint8_t value) {
  const int self_clearing = kDMP_RESET | kFIFO_RESET | kI2C_MST_RESET | kSIG_COND_RESET;
  registers_.poke(USER_CTRL, static_cast<std::uint8_t>(value & ~self_clearing));
  if ((value & kFIFO_RESET) != 0) clear_fifo();
  show_fifo();  // FIFO_EN may have changed
  if ((value & kSIG_COND_RESET) == 0) return;
  internal_.fill(0);
  board_.filters_unsettled();
  pending_ = true;
}

}  // namespace whirl::core
