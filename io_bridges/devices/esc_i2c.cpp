#include "io_bridges/devices/esc_i2c.hpp"

namespace whirl::io {

bool EscI2c::start(std::uint8_t /*address_7bit*/, bool read, Nanoseconds now) {
  finish(now);
  start_ns_ = now;
  if (!read) {
    writing_ = true;
    received_.clear();
    return true;
  }
  EscStatus status = status_;
  if (rejected_since_read_) status.flags |= EscFlag::kWriteRejected;
  rejected_since_read_ = false;
  answer_ = pack_status(address_, status);
  answered_ = 0;
  return true;
}

bool EscI2c::write(std::uint8_t byte, Nanoseconds /*now*/) {
  if (received_.size() < 4) received_.push_back(byte);  // four are enough to know it is too long
  return true;
}

std::uint8_t EscI2c::read(Nanoseconds /*now*/) {
  return answered_ < answer_.size() ? answer_[answered_++] : 0xFF;
}

void EscI2c::finish(Nanoseconds now) {
  if (!writing_) return;
  writing_ = false;
  ++writes_;
  const auto v = unpack_setpoint(address_, received_);
  if (!v) {
    ++rejected_;
    rejected_since_read_ = true;
  }
  if (sink_) sink_({v.has_value(), v.value_or(0), start_ns_, now});
}

}  // namespace whirl::io
