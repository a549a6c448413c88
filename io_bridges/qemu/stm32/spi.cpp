#include "io_bridges/qemu/stm32/spi.hpp"

#include <cmath>

#include "io_bridges/qemu/stm32/spi_bits.hpp"

namespace whirl::stm32 {
using namespace spi_bits;
namespace {

std::uint16_t reversed(std::uint16_t value, int bits) {
  std::uint16_t out = 0;
  for (int i = 0; i < bits; ++i) out = static_cast<std::uint16_t>((out << 1) | ((value >> i) & 1));
  return out;
}

}  // namespace

Spi::Spi(std::string name, Chip chip, int irq, bool on_apb2, SpiPins pins)
    : WordBlock(name),
      chip_(std::move(chip)),
      irq_(irq),
      on_apb2_(on_apb2),
      pins_(pins),
      bus_(name),
      frame_end_(chip_.events, [this] { end_frame(); }) {
  chip_.clocks.on_change([this] { clocks_changed(); });
  pins_.nss.watch([this](bool level, Nanoseconds) {
    slave_first_ = !level;
    check_mode_fault();
  });
  clocks_changed();
}

void Spi::reset() {
  frame_end_.cancel();
  cr1_ = cr2_ = rxcrc_ = txcrc_ = i2scfgr_ = 0;
  sr_ = TXE;
  crcpr_ = 7;
  i2spr_ = 2;
  tx_buffer_ = rx_buffer_ = 0;
  tx_full_ = shifting_ = crc_frame_ = frame_is_crc_ = ovr_dr_read_ = modf_sr_read_ = false;
  forget_slave_bits();
  drive_nss();
  clocks_changed();
  update();
}

void Spi::clocks_changed() {
  const double pclk_Hz = on_apb2_ ? chip_.clocks.pclk2_Hz() : chip_.clocks.pclk1_Hz();
  const double sck_Hz = pclk_Hz / (2u << ((cr1_ >> 3) & 7));
  const int bits = (cr1_ & DFF) != 0 ? 16 : 8;
  sck_Hz_ = static_cast<std::uint32_t>(std::lround(sck_Hz));
  frame_ns_ = sck_Hz > 0.0 ? std::llround(bits * 1e9 / sck_Hz) : 0;
}

std::uint32_t Spi::read_word(std::uint32_t offset) {
  switch (offset) {
    case CR1:
      return cr1_;
    case CR2:
      return cr2_;
    case SR:
      return read_sr();
    case DR:
      ovr_dr_read_ = true;
      sr_ &= ~RXNE;
      update();
      return rx_buffer_;
    case CRCPR:
      return crcpr_;
    case RXCRCR:
      return rxcrc_;
    case TXCRCR:
      return txcrc_;
    case I2SCFGR:
      return i2scfgr_;
    case I2SPR:
      return i2spr_;
    default:
      return 0;
  }
}

void Spi::write_word(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case CR1:
      return write_cr1(value & 0xFFFF);
    case CR2:
      cr2_ = value & 0xF7;
      drive_nss();
      check_mode_fault();
      return update();
    case SR:
      if ((value & CRCERR) == 0) sr_ &= ~CRCERR;  // rc_w0
      return update();
    case DR:
      return write_dr(static_cast<std::uint16_t>(value));
    case CRCPR:
      crcpr_ = value & 0xFFFF;
      return;
    case I2SCFGR:
      i2scfgr_ = value & 0xFBF;
      if ((value & (1u << 11)) != 0) report_once(8, "I2S mode is not modelled");
      return;
    case I2SPR:
      i2spr_ = value & 0x3FF;
      return;
    default:
      return;
  }
}

// OVR clears by reading DR, then SR; MODF by reading SR, then writing CR1.
std::uint32_t Spi::read_sr() {
  const bool busy = (cr1_ & MSTR) != 0 ? shifting_ || tx_full_ : shifting_ || slave_shifting_;
  const std::uint32_t value = sr_ | (busy ? BSY : 0);
  if ((sr_ & OVR) != 0 && ovr_dr_read_) {
    sr_ &= ~OVR;
    update();
  }
  modf_sr_read_ = (sr_ & MODF) != 0;
  return value;
}

void Spi::write_cr1(std::uint32_t value) {
  const std::uint32_t before = cr1_;
  cr1_ = value;
  if (modf_sr_read_) {
    sr_ &= ~MODF;
    modf_sr_read_ = false;
  }
  if ((value & (SPE | MSTR)) != SPE) forget_slave_bits();
  if ((before & CRCEN) == 0 && (value & CRCEN) != 0) rxcrc_ = txcrc_ = 0;
  if ((before & CRCNEXT) == 0 && (value & CRCNEXT) != 0) crc_frame_ = true;
  if (((before ^ value) & (DFF | 0x38)) != 0) clocks_changed();
  drive_nss();
  check_mode_fault();
  if (!shifting_) next_frame();
  update();
}

void Spi::drive_nss() {
  const bool output = (cr1_ & MSTR) != 0 && (cr1_ & SSM) == 0 && (cr2_ & SSOE) != 0;
  const Drive drive = !output ? Drive::none : (cr1_ & SPE) != 0 ? Drive::low : Drive::pull_high;
  pins_.nss.drive(drive, chip_.events.now());
}

void Spi::check_mode_fault() {
  if ((cr1_ & (MSTR | SPE)) != (MSTR | SPE)) return;
  const bool soft = (cr1_ & SSM) != 0;
  if (!soft && (cr2_ & SSOE) != 0) return;
  if (soft ? (cr1_ & SSI) != 0 : pins_.nss.level()) return;
  sr_ |= MODF;
  cr1_ &= ~(MSTR | SPE);
  update();
}

int Spi::mode() const {
  return static_cast<int>(((cr1_ & CPOL) != 0 ? 2 : 0) | ((cr1_ & CPHA) != 0 ? 1 : 0));
}

bool Spi::receive_only() const {
  if ((cr1_ & BIDIMODE) != 0) return (cr1_ & BIDIOE) == 0;
  return (cr1_ & RXONLY) != 0;
}
bool Spi::receives() const {
  return (cr1_ & BIDIMODE) == 0 || (cr1_ & BIDIOE) == 0;
}

void Spi::write_dr(std::uint16_t value) {
  tx_buffer_ = (cr1_ & DFF) != 0 ? value : value & 0xFF;
  tx_full_ = true;
  written_ns_ = chip_.events.now();
  sr_ &= ~TXE;
  if (!shifting_) next_frame();
  update();
}

// The shift register is free: what goes next, if anything?
void Spi::next_frame() {
  if ((cr1_ & (SPE | MSTR)) != (SPE | MSTR)) return;
  if (receive_only()) return begin_frame(0xFFFF);  // the clock runs as long as SPE
  if (tx_full_) {
    tx_full_ = false;
    sr_ |= TXE;
    return begin_frame(tx_buffer_);
  }
  if (crc_frame_ && (cr1_ & CRCEN) != 0) {
    crc_frame_ = false;
    frame_is_crc_ = true;
    begin_frame(static_cast<std::uint16_t>(txcrc_));
  }
}

void Spi::begin_frame(std::uint16_t value) {
  shift_ = value;
  shifting_ = true;
  frame_end_.in(frame_ns_);
  if (!pins_.sck.routed() || (cr1_ & DFF) != 0) return;
  bus_.begin(static_cast<std::uint8_t>(on_wire(value)), sck_Hz_, mode(), chip_.events.now());
}

void Spi::end_frame() {
  shifting_ = false;
  const std::uint16_t in = shift(shift_);
  if ((cr1_ & CRCEN) != 0 && !frame_is_crc_) txcrc_ = crc(txcrc_, shift_);
  if (receives()) received(in);
  frame_is_crc_ = false;
  next_frame();
  update();
}

// What is on MOSI, the first bit highest.
std::uint16_t Spi::on_wire(std::uint16_t mosi) const {
  const std::uint16_t out = pins_.mosi.routed() ? mosi : 0xFFFF;
  return (cr1_ & LSBFIRST) != 0 ? reversed(out, (cr1_ & DFF) != 0 ? 16 : 8) : out;
}

// The frame on the wire, as far as the pins carry it.
std::uint16_t Spi::shift(std::uint16_t mosi) {
  const Nanoseconds now = chip_.events.now();
  const int bits = (cr1_ & DFF) != 0 ? 16 : 8;
  if (!pins_.sck.routed()) {
    report_once(1, "transfer with no pin muxed to SCK");
    return 0xFFFF;
  }
  if (!receive_only() && !pins_.mosi.routed()) report_once(2, "transfer with no pin muxed to MOSI");
  const std::uint16_t out = on_wire(mosi);
  const bool lsb_first = (cr1_ & LSBFIRST) != 0;
  std::uint16_t in = 0;
  for (int at = bits - 8; at >= 0; at -= 8) {
    const auto byte = static_cast<std::uint8_t>(out >> at);
    in = static_cast<std::uint16_t>((in << 8) | bus_.transfer(byte, sck_Hz_, mode(), now));
  }
  const bool one_line = (cr1_ & BIDIMODE) != 0;
  if (receives() && !one_line && !pins_.miso.routed()) in = 0xFFFF;
  return lsb_first ? reversed(in, bits) : in;
}

void Spi::received(std::uint16_t value) {
  if ((cr1_ & DFF) == 0) value &= 0xFF;
  if ((cr1_ & CRCEN) != 0) {
    const std::uint32_t mask = (cr1_ & DFF) != 0 ? 0xFFFF : 0xFF;
    if (frame_is_crc_) {
      if ((value & mask) != (rxcrc_ & mask)) sr_ |= CRCERR;
    } else {
      rxcrc_ = crc(rxcrc_, value);
    }
  }
  if ((sr_ & RXNE) != 0) {
    sr_ |= OVR;  // DR keeps the older frame
    ovr_dr_read_ = false;
    return;
  }
  rx_buffer_ = value;
  sr_ |= RXNE;
}

std::uint16_t Spi::crc(std::uint32_t crc, std::uint16_t data) const {
  const int bits = (cr1_ & DFF) != 0 ? 16 : 8;
  const std::uint32_t top = 1u << (bits - 1), mask = (top << 1) - 1;
  crc ^= data;
  for (int i = 0; i < bits; ++i) crc = (crc & top) != 0 ? (crc << 1) ^ crcpr_ : crc << 1;
  return static_cast<std::uint16_t>(crc & mask);
}

void Spi::update() {
  if (!tx_full_) sr_ |= TXE;
  const std::uint32_t s = sr_;
  const bool irq = ((cr2_ & TXEIE) != 0 && (s & TXE) != 0) ||
                   ((cr2_ & RXNEIE) != 0 && (s & RXNE) != 0) ||
                   ((cr2_ & ERRIE) != 0 && (s & (OVR | MODF | CRCERR)) != 0);
  chip_.interrupts.set(irq_, irq);
  tx_request_.set((cr2_ & TXDMAEN) != 0 && (s & TXE) != 0);
  rx_request_.set((cr2_ & RXDMAEN) != 0 && (s & RXNE) != 0);
}

void Spi::report_once(std::uint32_t bit, const char* what) {
  if ((reported_ & bit) != 0 || !chip_.finding) return;
  reported_ |= bit;
  chip_.finding({chip_.events.now(), name(), what});
}

}  // namespace whirl::stm32
