#include "io_bridges/copper/uart_decoder.hpp"

#include <cmath>

namespace whirl::copper {
namespace {

constexpr int kBits = 10;

}  // namespace

std::int64_t UartDecoder::at(double bits) const {
  return start_ns_ + std::llround(bits * bit_ns_);
}

void UartDecoder::line(bool level, std::int64_t t_ns) {
  advance_to(t_ns);
  if (level == level_) return;
  level_ = level;
  if (open_ || level) return;
  open_ = true;
  start_ns_ = t_ns;
  bit_ = 0;
  bits_ = 0;
}

// An edge in the middle of a bit belongs to what follows.
void UartDecoder::advance_to(std::int64_t t_ns) {
  while (open_ && at(bit_ + 0.5) < t_ns) {
    bits_ |= (level_ ? 1u : 0u) << bit_;
    if (++bit_ < kBits) continue;
    open_ = false;
    const bool begins = (bits_ & 1) == 0, ends = (bits_ >> 9 & 1) != 0;
    if (begins && ends) {
      byte_({start_ns_, at(kBits), static_cast<std::uint8_t>(bits_ >> 1)});
    } else {
      unread_({start_ns_, at(kBits), begins ? "its stop bit is low" : "its start bit is high"});
    }
  }
}

}  // namespace whirl::copper
