// SPI as a slave: clocked by an external master; see spi.hpp.
#include <utility>

#include "io_bridges/qemu/stm32/spi.hpp"
#include "io_bridges/qemu/stm32/spi_bits.hpp"

namespace whirl::stm32 {
using namespace spi_bits;
namespace {

constexpr int kBits = 8;

}  // namespace

bool Spi::selected_as_slave() const {
  const bool selected = (cr1_ & SSM) != 0 ? (cr1_ & SSI) == 0 : !pins_.nss.level();
  return (cr1_ & (SPE | MSTR)) == SPE && selected && pins_.sck.routed();
}

// SPE = 0: the bit counter and what was on its way are gone; DR stays.
void Spi::forget_slave_bits() {
  slave_bits_ = 0;
  slave_loaded_ = slave_shifting_ = false;
}

void Spi::load_slave_shift() {
  if (!tx_full_) report_once(16, "slave clocked with nothing in DR: what it sends is unspecified");
  shift_ = tx_buffer_;
  tx_full_ = false;
  slave_loaded_ = true;
  slave_bits_ = 0;
  update();
}

Nanoseconds Spi::shift_out(Nanoseconds now) {
  if (!selected_as_slave()) return kNothing;
  slave_shifting_ = true;
  const bool waited = slave_loaded_ || tx_full_;
  if (!slave_loaded_) load_slave_shift();
  const Nanoseconds waited_ns = waited ? now - written_ns_ : kNothing;
  (std::exchange(slave_first_, false) ? slack_.first : slack_.others).add(waited_ns);
  return waited_ns;
}

std::uint8_t Spi::sampled(std::uint8_t mosi, int bits, Nanoseconds) {
  if (!selected_as_slave()) return 0xFF;
  if (!slave_shifting_) {
    report_once(32, "enabled as a slave inside a byte: its bits are lost");
    return 0xFF;
  }
  slave_shifting_ = false;
  std::uint8_t miso = 0;
  for (int i = bits - 1; i >= 0; --i) {
    if (!slave_loaded_) load_slave_shift();
    miso = static_cast<std::uint8_t>(miso << 1 | (shift_ >> (kBits - 1 - slave_bits_) & 1));
    slave_in_ = static_cast<std::uint8_t>(slave_in_ << 1 | (mosi >> i & 1));
    if (++slave_bits_ < kBits) continue;
    slave_loaded_ = false;
    received(slave_in_);
  }
  update();
  return pins_.miso.routed() ? miso : 0xFF;
}

}  // namespace whirl::stm32
