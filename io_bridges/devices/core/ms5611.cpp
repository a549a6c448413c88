#include "io_bridges/devices/core/ms5611.hpp"

namespace whirl::core {
namespace {

constexpr Nanoseconds kReload_ns = 2'800'000;
constexpr std::uint32_t kFastest_sck_Hz = 20'000'000;

}  // namespace

// ---- Commands

void Ms5611::command(std::uint8_t byte, Nanoseconds now) {
  clear_answer();
  if (now < ready_ns_) return board_.odd(Oddity::command_in_reload, byte, now);
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
  board_.odd(Oddity::unknown_command, byte, now);
}

void Ms5611::drop_conversion() {
  converting_ = waiting_ = false;
  board_.conversion_dropped();
}

void Ms5611::supply(bool on) {
  powered_ = on;
  drop_conversion();
  clear_answer();
  ready_ns_ = 0;
}

void Ms5611::reset(Nanoseconds now) {
  drop_conversion();
  ready_ns_ = now + kReload_ns;
}

void Ms5611::convert(Quantity quantity, std::size_t osr, Nanoseconds now) {
  spoiled_ = converting_;
  if (spoiled_) board_.odd(Oddity::conversion_disturbed, 0, now);
  quantity_ = quantity;
  osr_ = osr;
  converting_ = true;
  board_.conversion_begins(quantity, osr, now);
}

void Ms5611::converted(std::uint32_t fresh, bool frozen, std::uint32_t garbage) {
  std::uint32_t& newest = newest_[static_cast<std::size_t>(quantity_)];
  if (!frozen) newest = fresh;
  result_ = spoiled_ ? garbage & kMost_counts : newest;
  converting_ = false;
  waiting_ = true;
}

void Ms5611::read_adc(Nanoseconds now) {
  std::uint32_t value = 0;
  if (converting_) {
    spoiled_ = true;
    board_.odd(Oddity::adc_read_too_early, 0, now);
  } else if (!waiting_) {
    board_.odd(Oddity::adc_read_without_result, 0, now);
  } else {
    value = result_;
  }
  waiting_ = false;
  answer_ = {static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 8),
             static_cast<std::uint8_t>(value)};
  answer_size_ = 3;
}

void Ms5611::read_prom(std::size_t word, Nanoseconds now) {
  if (converting_) board_.odd(Oddity::prom_read_in_conversion, 0, now);
  const std::uint16_t value = word == 7 ? board_.last_prom_word(prom_[7], now) : prom_[word];
  answer_ = {static_cast<std::uint8_t>(value >> 8), static_cast<std::uint8_t>(value & 0xFF), 0};
  answer_size_ = 2;
}

// ---- SPI

void Ms5611::select() {
  command_passed_ = false;
  clear_answer();
}

std::uint8_t Ms5611::transfer(std::uint8_t mosi, std::uint32_t sck_Hz, int mode, Nanoseconds now) {
  if (mode != 0 && mode != 3) {
    board_.odd(Oddity::spi_mode, static_cast<std::uint32_t>(mode), now);
    return 0xFF;
  }
  if (sck_Hz > kFastest_sck_Hz) board_.odd(Oddity::sck_over_20_MHz, sck_Hz / 1000, now);
  if (!powered_) return 0xFF;
  const std::uint8_t idle = busy(now) ? 0x00 : 0xFF;  // SDO is held low until it is done
  if (command_passed_) return answer_waits() ? answer_[answer_next_++] : idle;
  command_passed_ = true;
  command(mosi, now);
  return idle;
}

// ---- I2C

bool Ms5611::start(bool read) {
  if (!powered_) return false;
  if (!read) command_passed_ = false;
  return true;
}

bool Ms5611::write(std::uint8_t byte, Nanoseconds now) {
  if (command_passed_) {
    board_.odd(Oddity::second_command_byte, byte, now);
    return true;
  }
  command_passed_ = true;
  command(byte, now);
  return true;
}

std::uint8_t Ms5611::read() {
  return answer_waits() ? answer_[answer_next_++] : 0x00;
}

}  // namespace whirl::core
