#include "io_bridges/devices/esc_i2c.hpp"

namespace whirl::io {

bool EscI2c::start(std::uint8_t /*address_7bit*/, bool read, Nanoseconds now) {
  report(part_.start(read), now);
  start_ns_ = now;
  return true;
}

void EscI2c::report(const std::optional<core::EscI2c::Write>& ended, Nanoseconds now) {
  if (ended && sink_) sink_({ended->valid, ended->v, start_ns_, now});
}

}  // namespace whirl::io
