#include "io_bridges/copper/i2c_decoder.hpp"

namespace whirl::copper {
namespace {

constexpr int kClocks = 9;  // of a byte and its acknowledge

}  // namespace

void I2cDecoder::scl(bool level, std::int64_t t_ns) {
  if (level == scl_) return;
  scl_ = level;
  if (!open_) return;
  if (level) {
    ++clocks_;
    bits_ = bits_ << 1 | (sda_ ? 1u : 0u);
  } else if (clocks_ > 0 && clocks_ % kClocks == 0) {
    nine();
    if (addressed_ && clocks_ > kClocks) now_.passed_ns.push_back(t_ns);
  }
}

// A byte is whole with its ninth clock. The read's last byte is refused by the controller: it wants no more.
void I2cDecoder::nine() {
  const auto byte = static_cast<std::uint8_t>(bits_ >> 1);
  const bool refused = (bits_ & 1) != 0;
  bits_ = 0;
  if (!addressed_) {
    addressed_ = true;
    now_.address = byte >> 1;
    now_.read = (byte & 1) != 0;
    now_.acked = !refused;
    return;
  }
  now_.bytes.push_back(byte);
  if (!now_.read && refused) now_.acked = false;
}

void I2cDecoder::sda(bool level, std::int64_t t_ns) {
  if (level == sda_) return;
  sda_ = level;
  if (!scl_) return;
  // The clock that is high while SDA moves is the one of the STOP or the repeated START: it carries no bit.
  if (open_) end(t_ns);
  if (!level) start(t_ns);
}

void I2cDecoder::start(std::int64_t t_ns) {
  open_ = true;
  now_ = {};
  now_.start_ns = t_ns;
  clocks_ = 0;
  bits_ = 0;
  addressed_ = false;
}

void I2cDecoder::end(std::int64_t t_ns) {
  open_ = false;
  now_.stop_ns = t_ns;
  const int whole = clocks_ > 0 ? clocks_ - 1 : 0;  // less that of the STOP itself
  if (clocks_ > 0 && whole % kClocks == 0 && whole > 0) {
    frame_(now_);
    return;
  }
  unread_({now_.start_ns, t_ns,
           std::to_string(whole) + " clocks between START and STOP are no multiple of nine"});
}

}  // namespace whirl::copper
