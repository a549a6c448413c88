#include "io_bridges/devices/i2c_bus.hpp"

namespace whirl::io {

I2cBus::I2cBus(std::string name)
    : name_(std::move(name)), sda_(name_ + ".SDA"), scl_(name_ + ".SCL") {
  for (Wire* wire : {&sda_, &scl_}) {  // the board's resistors
    wire->drive(wire->add_driver(), Drive::pull_high, 0);
  }
}

void I2cBus::finish(bool repeated, Nanoseconds now) {
  current_.stop_ns = now;
  current_.repeated_start = repeated;
  if (log_) log_(current_);
}

void I2cBus::byte_passed(Nanoseconds now) {
  current_.passed_ns.push_back(now);
}

void I2cBus::start(Nanoseconds now) {
  if (busy_) finish(true, now);
  busy_ = true;
  addressed_.clear();
  current_ = {};
  current_.start_ns = now;
  for (const auto& started : on_start_) started(now);
}

bool I2cBus::address(std::uint8_t address_7bit, bool read, Nanoseconds now) {
  current_.address = address_7bit;
  current_.read = read;
  for (I2cTarget* target : targets_) {
    if (!sda_.level() || !target->answers(address_7bit)) continue;
    if (faults_ != nullptr &&
        (faults_->deaf(address_7bit, now) || !faults_->ack(address_7bit, -1, now))) {
      continue;
    }
    if (target->start(address_7bit, read, now)) addressed_.push_back(target);
  }
  if (!addressed_.empty() && faults_ != nullptr) {
    hold_until(now + faults_->stretch(address_7bit, now));
  }
  current_.address_acked = !addressed_.empty() || !sda_.level();
  return current_.address_acked;
}

bool I2cBus::write(std::uint8_t byte, Nanoseconds now) {
  if (!addressed_.empty() && faults_ != nullptr) {
    byte = faults_->byte(current_.address, index(), byte, now);
  }
  if (!sda_.level()) byte = 0x00;
  bool ack = false;
  for (I2cTarget* target : addressed_) ack = target->write(byte, now) || ack;
  if (ack && faults_ != nullptr) ack = faults_->ack(current_.address, index(), now);
  ack = ack || !sda_.level();
  current_.bytes.push_back(byte);
  byte_passed(now);
  current_.all_acked = current_.all_acked && ack;
  return ack;
}

std::uint8_t I2cBus::fetch(Nanoseconds now) {
  std::uint8_t byte = 0xFF;  // nobody pulls SDA low
  for (I2cTarget* target : addressed_) byte &= target->read(now);
  if (!addressed_.empty() && faults_ != nullptr) {
    byte = faults_->byte(current_.address, index(), byte, now);
  }
  if (!sda_.level()) byte = 0x00;
  current_.bytes.push_back(byte);
  return byte;
}

void I2cBus::answer(bool ack, Nanoseconds now) {
  byte_passed(now);
  for (I2cTarget* target : addressed_) target->acked(ack, now);
}

std::uint8_t I2cBus::read(bool ack, Nanoseconds now) {
  const std::uint8_t byte = fetch(now);
  answer(ack, now);
  return byte;
}

void I2cBus::abandon(Nanoseconds now) {
  for (I2cTarget* target : addressed_) target->abandoned(now);
}

void I2cBus::stop(Nanoseconds now) {
  if (!busy_) return;
  for (I2cTarget* target : addressed_) target->stop(now);
  finish(false, now);
  set_free(now);
}

void I2cBus::stop_unseen(Nanoseconds now) {
  if (busy_) set_free(now);
}

void I2cBus::set_free(Nanoseconds now) {
  addressed_.clear();
  busy_ = false;
  for (const auto& free : on_free_) free(now);
}

}  // namespace whirl::io
