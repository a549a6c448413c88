#include "io_bridges/qemu/stm32/usart.hpp"

#include <cmath>

#include "io_bridges/devices/uart_sampling.hpp"

namespace whirl::stm32 {
namespace {

enum Offset : std::uint32_t {
  SR = 0x00,
  DR = 0x04,
  BRR = 0x08,
  CR1 = 0x0C,
  CR2 = 0x10,
  CR3 = 0x14,
  GTPR = 0x18,
};
// SR
constexpr std::uint32_t PE = 1u << 0, FE = 1u << 1, NF = 1u << 2, ORE = 1u << 3, IDLE = 1u << 4,
                        RXNE = 1u << 5, TC = 1u << 6, TXE = 1u << 7, LBD = 1u << 8, CTS = 1u << 9;
// CR1
constexpr std::uint32_t SBK = 1u << 0, RWU = 1u << 1, RE = 1u << 2, TE = 1u << 3, IDLEIE = 1u << 4,
                        RXNEIE = 1u << 5, TCIE = 1u << 6, TXEIE = 1u << 7, PEIE = 1u << 8,
                        PS = 1u << 9, PCE = 1u << 10, WAKE = 1u << 11, M = 1u << 12, UE = 1u << 13,
                        OVER8 = 1u << 15;
// CR2
constexpr std::uint32_t LBDIE = 1u << 6, LINEN = 1u << 14, CLKEN = 1u << 11;
// CR3
constexpr std::uint32_t EIE = 1u << 0, IREN = 1u << 1, HDSEL = 1u << 3, SCEN = 1u << 5,
                        DMAR = 1u << 6, DMAT = 1u << 7, RTSE = 1u << 8, CTSE = 1u << 9,
                        CTSIE = 1u << 10;

}  // namespace

Usart::Usart(std::string name, Chip chip, int irq, bool on_apb2, UsartPins pins)
    : WordBlock(std::move(name)),
      chip_(std::move(chip)),
      irq_(irq),
      on_apb2_(on_apb2),
      pins_(pins),
      tx_end_(chip_.events, [this] { character_sent(); }),
      idle_(chip_.events, [this] { idle_passed(); }) {
  chip_.clocks.on_change([this] { settings_changed(); });
  pins_.cts.watch([this](bool level, Nanoseconds) {
    if ((cr3_ & CTSE) == 0) return;
    sr_ |= CTS;
    if (!level && sending_ == Sending::nothing) next_character();
    update();
  });
}

void Usart::join(io::UartPeer& peer) {
  peer_ = &peer;
  early_ = dynamic_cast<io::EarlyUartPeer*>(&peer);
  peer.join(
      [this](const io::UartByte& byte, const io::UartFormat& format) { receive(byte, format); });
}

void Usart::reset() {
  tx_end_.cancel();
  idle_.cancel();
  sr_ = TXE | TC;
  brr_ = cr1_ = cr2_ = cr3_ = gtpr_ = sr_seen_ = 0;
  tdr_ = rdr_ = tx_shift_ = 0;
  sending_ = Sending::nothing;
  idle_frame_wanted_ = false;
  settings_changed();
  update();
}

int Usart::word_bits() const {
  return (cr1_ & M) != 0 ? 9 : 8;
}

Nanoseconds Usart::frame_ns() const {
  return baud_ > 0.0 ? std::llround((1 + word_bits() + stop_bits_) * 1e9 / baud_) : 0;
}

// BRR holds USARTDIV: 12.4 bits with 16 samples per bit, 12.3 with 8.
void Usart::settings_changed() {
  const double pclk_Hz = on_apb2_ ? chip_.clocks.pclk2_Hz() : chip_.clocks.pclk1_Hz();
  const std::uint32_t divisor =
      (cr1_ & OVER8) != 0 ? ((brr_ >> 4) << 3) | (brr_ & 7) : brr_ & 0xFFFF;
  baud_ = divisor != 0 ? pclk_Hz / divisor : 0.0;
  static constexpr double kStop[4] = {1.0, 0.5, 2.0, 1.5};
  stop_bits_ = kStop[(cr2_ >> 12) & 3];
}

std::uint32_t Usart::read_word(std::uint32_t offset) {
  switch (offset) {
    case SR:
      sr_seen_ = sr_;
      return sr_;
    case DR:
      return read_dr();
    case BRR:
      return brr_;
    case CR1:
      return cr1_;
    case CR2:
      return cr2_;
    case CR3:
      return cr3_;
    case GTPR:
      return gtpr_;
    default:
      return 0;
  }
}

void Usart::write_word(std::uint32_t offset, std::uint32_t value) {
  value &= 0xFFFF;
  switch (offset) {
    case SR:
      return write_sr(value);
    case DR:
      return write_dr(value);
    case BRR:
      brr_ = value;
      return settings_changed();
    case CR1:
      return write_cr1(value);
    case CR2:
      cr2_ = value;
      if ((value & CLKEN) != 0) report_once(2, "synchronous clock is not modelled");
      settings_changed();
      return update();
    case CR3:
      cr3_ = value;
      if ((value & (IREN | SCEN)) != 0) report_once(4, "IrDA and smartcard modes are not modelled");
      return update();
    case GTPR:
      gtpr_ = value;
      return;
    default:
      return;
  }
}

void Usart::write_sr(std::uint32_t value) {
  sr_ &= value | ~(CTS | LBD | TC | RXNE);  // rc_w0; the others ignore writes
  update();
}

std::uint32_t Usart::read_dr() {
  const std::uint32_t cleared = sr_seen_ & (PE | FE | NF | ORE | IDLE);
  sr_ &= ~(cleared | RXNE);
  sr_seen_ = 0;
  update();
  return rdr_;
}

void Usart::write_dr(std::uint32_t value) {
  tdr_ = static_cast<std::uint16_t>(value & 0x1FF);
  if ((sr_seen_ & TC) != 0) sr_ &= ~TC;  // SR was read, now DR is written
  sr_seen_ &= ~TC;
  sr_ &= ~TXE;
  if (sending_ == Sending::nothing) next_character();
  update();
}

void Usart::write_cr1(std::uint32_t value) {
  const std::uint32_t before = cr1_;
  cr1_ = value;
  settings_changed();
  const auto transmits = [](std::uint32_t cr1) { return (cr1 & (UE | TE)) == (UE | TE); };
  if ((value & UE) == 0) {  // disabled: prescaler and outputs stop at the end of the character
    idle_.cancel();
  }
  if (transmits(value) && !transmits(before)) idle_frame_wanted_ = true;
  if (transmits(value) && baud_ <= 0.0) report_once(8, "enabled with BRR 0");
  if (sending_ == Sending::nothing) next_character();
  update();
}

// The shift register is free: an idle frame, a break or the next character, in this order.
void Usart::next_character() {
  if ((cr1_ & (UE | TE)) != (UE | TE) || baud_ <= 0.0) return;
  if (idle_frame_wanted_) {
    idle_frame_wanted_ = false;
    sending_ = Sending::idle_frame;
  } else if ((cr1_ & SBK) != 0) {
    sending_ = Sending::break_character;
  } else if ((sr_ & TXE) == 0) {
    if ((cr3_ & CTSE) != 0 && pins_.cts.level()) return;
    tx_shift_ = tdr_;
    sr_ |= TXE;
    sending_ = Sending::character;
  } else {
    return;
  }
  tx_end_.in(frame_ns());
  announce(tx_end_.due());
}

void Usart::character_sent() {
  const Sending sent = sending_;
  sending_ = Sending::nothing;
  if (sent == Sending::break_character) cr1_ &= ~SBK;
  if (sent == Sending::character) send_to_peer(tx_shift_, false);
  if (sent == Sending::break_character) send_to_peer(0, true);
  next_character();
  if (sending_ == Sending::nothing && (sr_ & TXE) != 0) sr_ |= TC;
  update();
}

io::UartFormat Usart::format() const {
  const int data_bits = word_bits() - ((cr1_ & PCE) != 0 ? 1 : 0);
  io::UartFormat format{baud_, data_bits, 'N', stop_bits_};
  if ((cr1_ & PCE) != 0) format.parity = (cr1_ & PS) != 0 ? 'O' : 'E';
  return format;
}

io::UartByte Usart::on_line(std::uint16_t bits, bool is_break) const {
  io::UartByte byte;
  byte.value = static_cast<std::uint8_t>(bits & ((1u << format().data_bits) - 1));
  byte.is_break = is_break;
  return byte;
}

void Usart::announce(Nanoseconds end) {
  if (early_ == nullptr || sending_ == Sending::idle_frame || !pins_.tx.routed()) return;
  const bool is_break = sending_ == Sending::break_character;
  early_->begin(on_line(is_break ? 0 : tx_shift_, is_break), format(), chip_.events.now(), end);
}

void Usart::send_to_peer(std::uint16_t bits, bool is_break) {
  const io::UartByte byte = on_line(bits, is_break);
  const bool half_duplex = (cr3_ & HDSEL) != 0;
  if (!pins_.tx.routed()) return report_once(1, "sending with no pin muxed to TX");
  if (half_duplex && (cr1_ & RE) != 0) receive(byte, format());  // one wire: it hears itself
  if (peer_ != nullptr) peer_->receive(byte, format(), chip_.events.now());
}

void Usart::receive(const io::UartByte& byte, const io::UartFormat& format) {
  if ((cr1_ & (UE | RE)) != (UE | RE) || baud_ <= 0.0) return;
  const bool half_duplex = (cr3_ & HDSEL) != 0;
  if (!(half_duplex ? pins_.tx : pins_.rx).routed()) return;
  line_idle();
  const io::UartSample sample = io::sample_uart(byte, format, word_bits(), baud_);
  std::uint32_t errors = 0;
  if (sample.stop_missing) errors |= FE;
  if (sample.noise) errors |= NF;
  if (sample.stop_missing && sample.bits == 0 && (cr2_ & LINEN) != 0) sr_ |= LBD;
  if ((cr1_ & PCE) != 0 && io::odd_number_of_ones(sample.bits) != ((cr1_ & PS) != 0)) errors |= PE;
  receive(sample.bits, errors);
  last_rx_end_ = chip_.events.now();
  idle_.in(2 * frame_ns());
  update();
}

// A character came. Did the line rest for a frame before it began? Then IDLE is due.
void Usart::line_idle() {
  if (!idle_.pending()) return;
  const Nanoseconds gap = chip_.events.now() - last_rx_end_ - frame_ns();
  idle_.cancel();
  if (gap >= frame_ns()) idle_passed();
}

void Usart::idle_passed() {
  if ((cr1_ & RWU) != 0) {
    if ((cr1_ & WAKE) == 0) cr1_ &= ~RWU;  // woken by the idle line, without IDLE
    return;
  }
  sr_ |= IDLE;
  update();
}

bool Usart::muted(std::uint16_t bits) {
  if ((cr1_ & WAKE) == 0) return (cr1_ & RWU) != 0;
  const int top = word_bits() - ((cr1_ & PCE) != 0 ? 2 : 1);
  if (((bits >> top) & 1) != 0) {  // an address mark
    const bool mine = (bits & 0xFu) == (cr2_ & 0xF);
    cr1_ = mine ? cr1_ & ~RWU : cr1_;
    return !mine && (cr1_ & RWU) != 0;
  }
  return (cr1_ & RWU) != 0;
}

void Usart::receive(std::uint16_t bits, std::uint32_t errors) {
  if (muted(bits)) return;
  if ((sr_ & RXNE) != 0) {
    sr_ |= ORE;  // DR keeps the older character
    return;
  }
  rdr_ = bits;
  sr_ |= RXNE | errors;
}

void Usart::update() {
  const bool errors = (sr_ & (FE | NF | ORE)) != 0 && (cr3_ & (EIE | DMAR)) == (EIE | DMAR);
  const bool irq =
      ((cr1_ & TXEIE) != 0 && (sr_ & TXE) != 0) || ((cr1_ & TCIE) != 0 && (sr_ & TC) != 0) ||
      ((cr1_ & RXNEIE) != 0 && (sr_ & (RXNE | ORE)) != 0) ||
      ((cr1_ & IDLEIE) != 0 && (sr_ & IDLE) != 0) || ((cr1_ & PEIE) != 0 && (sr_ & PE) != 0) ||
      ((cr2_ & LBDIE) != 0 && (sr_ & LBD) != 0) || ((cr3_ & CTSIE) != 0 && (sr_ & CTS) != 0) ||
      errors;
  chip_.interrupts.set(irq_, irq);
  const bool enabled = (cr1_ & UE) != 0;
  tx_request_.set(enabled && (cr1_ & TE) != 0 && (cr3_ & DMAT) != 0 && (sr_ & TXE) != 0);
  rx_request_.set(enabled && (cr3_ & DMAR) != 0 && (sr_ & RXNE) != 0);
  drive_pins();
}

void Usart::drive_pins() {
  const bool transmits = (cr1_ & (UE | TE)) == (UE | TE);
  const Drive tx = transmits ? Drive::high : Drive::none;  // idle; characters pass as a whole
  const Drive full = (sr_ & RXNE) != 0 ? Drive::high : Drive::low;
  const Drive rts = (cr3_ & RTSE) != 0 ? full : Drive::none;
  if (tx != pins_.tx.driven()) pins_.tx.drive(tx, chip_.events.now());
  if (rts != pins_.rts.driven()) pins_.rts.drive(rts, chip_.events.now());
}

void Usart::report_once(std::uint32_t bit, const char* what) {
  if ((reported_ & bit) != 0 || !chip_.finding) return;
  reported_ |= bit;
  chip_.finding({chip_.events.now(), name(), what});
}

}  // namespace whirl::stm32
