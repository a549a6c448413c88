#include "io_bridges/qemu/stm32/i2c.hpp"

#include <algorithm>
#include <cmath>

#include "io_bridges/qemu/stm32/i2c_bits.hpp"

namespace whirl::stm32 {
using namespace i2c_bits;

I2c::I2c(std::string name, Chip chip, int event_irq, int error_irq, I2cPins pins)
    : WordBlock(name),
      chip_(std::move(chip)),
      event_irq_(event_irq),
      error_irq_(error_irq),
      pins_(pins),
      bus_(name),
      step_(chip_.events, [this] { step(); }) {
  bus_.add(*this);
  bus_.on_free([this](Nanoseconds) { line_changed(); });
  bus_.scl().watch([this](bool, Nanoseconds) { line_changed(); });
  bus_.sda().watch([this](bool, Nanoseconds) { line_changed(); });
  chip_.clocks.on_change([this] { clocks_changed(); });
  rx_request_.on_last_but_one([this] { dma_last_ = (cr2_ & LAST) != 0; });
  clocks_changed();
}

// PE = 0 and SWRST: flags and lines go, settings stay.
void I2c::clear_state() {
  step_.cancel();
  const bool owned = master_ || phase_ == Phase::stopping;
  phase_ = Phase::idle;
  slave_ = Slave::none;
  master_ = transmitter_ = dr_full_ = shift_full_ = nacked_ = dma_last_ = false;
  waits_for_scl_ = fetch_due_ = false;
  general_call_ = second_address_ = false;
  sr1_ = sr1_seen_ = 0;
  cr1_ &= ~(START | STOP | ACK | POS | PEC);
  pins_.scl.drive(Drive::none, chip_.events.now());
  pins_.sda.drive(Drive::none, chip_.events.now());
  if (owned) bus_.stop(chip_.events.now());  // both lines rise: the others see a STOP
}

void I2c::reset() {
  clear_state();
  cr1_ = cr2_ = oar1_ = oar2_ = ccr_ = 0;
  trise_ = 2;
  dr_ = shift_ = 0;
  clocks_changed();
  update();
}

void I2c::clocks_changed() {
  const double pclk_Hz = chip_.clocks.pclk1_Hz();
  const int per_bit = (ccr_ & FS) == 0 ? 2 : (ccr_ & DUTY) == 0 ? 3 : 25;
  const std::uint32_t ccr = std::max(ccr_ & 0xFFF, 1u);
  bit_ns_ = pclk_Hz > 0.0 ? per_bit * ccr * 1e9 / pclk_Hz : 1e3;
}

std::uint32_t I2c::read_word(std::uint32_t offset) {
  switch (offset) {
    case CR1:
      return cr1_;
    case CR2:
      return cr2_;
    case OAR1:
      return oar1_;
    case OAR2:
      return oar2_;
    case DR:
      return read_dr();
    case SR1:
      return read_sr1();
    case SR2:
      return read_sr2();
    case CCR:
      return ccr_;
    case TRISE:
      return trise_;
    default:
      return 0;
  }
}

void I2c::write_word(std::uint32_t offset, std::uint32_t value) {
  value &= 0xFFFF;
  if ((cr1_ & SWRST) != 0 && offset != CR1) return;  // held in reset
  switch (offset) {
    case CR1:
      return write_cr1(value);
    case CR2:
      cr2_ = value & 0x1F3F;
      return update();
    case OAR1:
      oar1_ = value & 0xC3FF;
      return;
    case OAR2:
      oar2_ = value & 0xFF;
      return;
    case DR:
      return write_dr(static_cast<std::uint8_t>(value));
    case SR1:
      sr1_ &= value | ~kErrors;  // rc_w0
      return update();
    case CCR:
      if ((cr1_ & PE) == 0) ccr_ = value & 0xCFFF;
      return clocks_changed();
    case TRISE:
      if ((cr1_ & PE) == 0) trise_ = value & 0x3F;
      return;
    default:
      return;
  }
}

void I2c::write_cr1(std::uint32_t value) {
  if ((value & SWRST) != 0) {
    reset();
    cr1_ = SWRST;
    return;
  }
  if ((sr1_seen_ & STOPF) != 0) {  // SR1 was read, now CR1 is written
    sr1_ &= ~STOPF;
    sr1_seen_ &= ~STOPF;
  }
  const bool was_enabled = (cr1_ & PE) != 0;
  cr1_ = value & 0xBFFB;
  if ((cr1_ & PE) == 0) {
    if (was_enabled) clear_state();
    cr1_ &= ~(START | STOP | ACK | POS | PEC);
    return update();
  }
  if ((cr1_ & STOP) != 0 && !master_ && phase_ == Phase::idle) cr1_ &= ~STOP;
  if ((cr1_ & START) != 0 && !master_) check_setup();
  act();
  update_stretch();
  update();
}

std::uint32_t I2c::read_sr1() {
  sr1_seen_ = sr1_;
  return sr1_;
}

std::uint32_t I2c::read_sr2() {
  std::uint32_t value = 0;
  if (master_) value |= MSL;
  if (routed() && (bus_.busy() || !lines_high())) value |= BUSY;
  if (transmitter_) value |= TRA;
  if (general_call_) value |= GENCALL;
  if (second_address_) value |= DUALF;
  if ((sr1_seen_ & sr1_ & ADDR) != 0) {
    sr1_ &= ~ADDR;
    sr1_seen_ &= ~ADDR;
    address_cleared();
    update();
  }
  return value;
}

void I2c::address_cleared() {
  if (slave_ == Slave::transmitter && dr_full_) load_slave_shift();
  if (slave_ != Slave::none) return update_stretch();
  if (!master_ || phase_ != Phase::holding) return;
  if (!transmitter_) return begin_receive();
  if ((cr1_ & (START | STOP)) != 0) return act();
  if (dr_full_) load_shift();
}

void I2c::write_dr(std::uint8_t value) {
  if ((sr1_ & SB) != 0) {
    if ((sr1_seen_ & SB) == 0) return;  // SB wants SR1 read first
    sr1_ &= ~SB;
    shift_ = value;
    nacked_ = false;
    begin_bits(Phase::addressing, 9);
    return update();
  }
  if (!transmitter_) return;
  sr1_ &= ~BTF;
  dr_ = value;
  dr_full_ = true;
  sr1_ &= ~TXE;
  const bool free = (sr1_ & ADDR) == 0 && !nacked_;
  if (slave_ == Slave::transmitter && free && !shift_full_) load_slave_shift();
  if (master_ && free && phase_ == Phase::holding) load_shift();
  update_stretch();
  update();
}

std::uint8_t I2c::read_dr() {
  const std::uint8_t value = dr_;
  if (transmitter_) {  // reading DR clears BTF in either direction
    sr1_ &= ~(sr1_seen_ & BTF);
    update();
    return value;
  }
  if ((sr1_ & RXNE) == 0) return value;
  sr1_ &= ~(RXNE | BTF);
  if (shift_full_) {
    dr_ = shift_;
    shift_full_ = false;
    sr1_ |= RXNE;
    if (master_ && phase_ == Phase::holding && !nacked_) begin_receive();
    update_stretch();
  }
  update();
  return value;
}

void I2c::line_changed() {
  if (waits_for_scl_ && bus_.scl().level()) {
    waits_for_scl_ = false;
    if (phase_ == Phase::stopping) {
      step_.in(std::llround(bit_ns_));
    } else {
      begin_bits(phase_, 9);
    }
  } else if (phase_ == Phase::stopping && !step_.pending() && lines_high()) {
    step_.in(std::llround(bit_ns_));
  }
  try_start();
}

void I2c::update() {
  const bool buffer = (cr2_ & ITBUFEN) != 0 && (sr1_ & (TXE | RXNE)) != 0;
  const bool event = (sr1_ & (SB | ADDR | ADD10 | STOPF | BTF)) != 0 || buffer;
  chip_.interrupts.set(event_irq_, (cr2_ & ITEVTEN) != 0 && event);
  chip_.interrupts.set(error_irq_, (cr2_ & ITERREN) != 0 && (sr1_ & kErrors) != 0);
  const bool dma = (cr2_ & DMAEN) != 0;
  tx_request_.set(dma && transmitter_ && !nacked_ && (sr1_ & TXE) != 0);
  rx_request_.set(dma && (sr1_ & RXNE) != 0);
}

void I2c::check_setup() {
  if (!routed()) report_once(1, "START with SCL or SDA not muxed to a pin");
  const double pclk_MHz = chip_.clocks.nominal_Hz(chip_.clocks.pclk1_Hz()) / 1e6;
  if (std::abs((cr2_ & 0x3F) - pclk_MHz) > 0.6) report_once(2, "CR2.FREQ is not PCLK1 in MHz");
  const double rate_Hz = 1e9 / bit_ns_;
  if (rate_Hz > ((ccr_ & FS) != 0 ? 405e3 : 101e3))
    report_once(4, "bit rate above its mode's limit");
}

void I2c::report_once(std::uint32_t bit, const char* what) {
  if ((reported_ & bit) != 0 || !chip_.finding) return;
  reported_ |= bit;
  chip_.finding({chip_.events.now(), name(), what});
}

}  // namespace whirl::stm32
