#include "io_bridges/qemu/stm32/gpio_f1.hpp"

namespace whirl::stm32 {
namespace {

enum Offset : std::uint32_t {
  CRL = 0x00,
  CRH = 0x04,
  IDR = 0x08,
  ODR = 0x0C,
  BSRR = 0x10,
  BRR = 0x14,
  LCKR = 0x18,
};

}  // namespace

GpioF1::GpioF1(Chip chip, PinBank& bank, char port)
    : WordBlock(std::string("GPIO") + port), chip_(std::move(chip)), bank_(bank), port_(port) {
  pins_ = bank.make_port(port, [this](int pin, bool level, Nanoseconds now) {
    levels_ = level ? levels_ | (1u << pin) : levels_ & ~(1u << pin);
    if (edge_) edge_(pin, level, now);
  });
}

void GpioF1::add_signal(int pin, const RemapRow& row, Signal& signal) {
  signals_[static_cast<std::size_t>(pin)].push_back({&row, &signal});
  bank_.connect(*pins_[static_cast<std::size_t>(pin)], signal);
}

void GpioF1::remap(std::uint32_t mapr) {
  mapr_ = mapr;
  for (int pin = 0; pin < 16; ++pin) apply(pin);
}

void GpioF1::reset() {
  cr_[0] = cr_[1] = 0x44444444;  // floating inputs
  odr_ = 0;
  lock_.reset();
  for (int pin = 0; pin < 16; ++pin) apply(pin);
}

std::uint32_t GpioF1::read_word(std::uint32_t offset) {
  switch (offset) {
    case CRL:
      return cr_[0];
    case CRH:
      return cr_[1];
    case IDR:
      return levels_ & ~analog_;
    case ODR:
      return odr_;
    case LCKR:
      return lock_.read();
    default:
      return 0;
  }
}

void GpioF1::write_word(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case CRL:
      return set_configuration(0, value);
    case CRH:
      return set_configuration(8, value);
    case ODR:
      return set_odr(value & 0xFFFF);
    case BSRR:
      return set_odr((odr_ & ~(value >> 16)) | (value & 0xFFFF));
    case BRR:
      return set_odr(odr_ & ~(value & 0xFFFF));
    case LCKR:
      return lock_.write(value);
    default:
      return;
  }
}

// ODR also chooses between pull-up and pull-down of inputs, so each changed pin is set anew.
void GpioF1::set_odr(std::uint32_t value) {
  std::uint32_t changed = odr_ ^ value;
  odr_ = value;
  for (; changed != 0; changed &= changed - 1) apply(__builtin_ctz(changed));
}

void GpioF1::set_configuration(int first, std::uint32_t value) {
  std::uint32_t& reg = cr_[first / 8];
  for (int pin = first; pin < first + 8; ++pin) {
    const std::uint32_t mask = 0xFu << (4 * (pin - first));
    if (((reg ^ value) & mask) == 0) continue;
    if (lock_.holds(pin)) continue;
    reg = (reg & ~mask) | (value & mask);
    apply(pin);
  }
}

PinSetting GpioF1::setting(int pin) const {
  const std::uint32_t field = (cr_[pin / 8] >> (4 * (pin % 8))) & 0xF;
  const std::uint32_t mode = field & 3, cnf = field >> 2;
  const bool odr = ((odr_ >> pin) & 1) != 0;
  PinSetting s;
  s.output = odr;
  if (mode == 0) {
    s.mode = cnf == 0 ? PinMode::analog : PinMode::input;
    if (cnf == 2) s.pull = odr ? Drive::pull_high : Drive::pull_low;
  } else {
    s.mode = cnf >= 2 ? PinMode::alternate : PinMode::output;
    s.open_drain = (cnf & 1) != 0;
  }
  if (s.mode == PinMode::analog) return s;
  std::size_t n = 0;
  for (const Carried& c : signals_[static_cast<std::size_t>(pin)]) {
    const bool here = ((c.row->values >> ((mapr_ >> c.row->shift) & c.row->mask)) & 1) != 0;
    const bool carries = s.mode == PinMode::alternate || c.row->input;
    if (here && carries && n < s.signals.size()) s.signals[n++] = c.signal;
  }
  return s;
}

void GpioF1::apply(int pin) {
  Pin& p = *pins_[static_cast<std::size_t>(pin)];
  const PinSetting s = setting(pin);
  const std::uint32_t bit = 1u << pin;
  analog_ = s.mode == PinMode::analog ? analog_ | bit : analog_ & ~bit;
  check_jtag(pin, s.mode);
  const Nanoseconds now = chip_.events.now();
  for (const Signal* signal : s.signals) {
    // Only an open-drain pin is soldered to an I2C bus: PB6 may as well carry TIM4's PWM.
    io::Wire* net = signal != nullptr && s.open_drain ? bank_.net(signal) : nullptr;
    if (net != nullptr) p.join(*net, now);
  }
  p.set(s, now);
}

// After reset JTAG owns five pins; SWJ_CFG 1 frees PB4, 2 all but PA13 and PA14, 4 all.
void GpioF1::check_jtag(int pin, PinMode mode) {
  if (jtag_reported_ || (mode != PinMode::output && mode != PinMode::alternate)) return;
  const std::uint32_t swj = (mapr_ >> 24) & 7;
  const bool debug = port_ == 'A' && (pin == 13 || pin == 14);
  const bool jtag = (port_ == 'A' && pin == 15) || (port_ == 'B' && pin == 3);
  const bool njtrst = port_ == 'B' && pin == 4;
  const bool owned = (debug && swj != 4) || (jtag && swj < 2) || (njtrst && swj < 1);
  if (!owned || !chip_.finding) return;
  jtag_reported_ = true;
  chip_.finding({chip_.events.now(), "AFIO",
                 std::string("P") + port_ + std::to_string(pin) +
                     " is an output while SWJ_CFG leaves it to JTAG"});
}

void Afio::reset() {
  ports_.reset();
  evcr_ = mapr_ = mapr2_ = 0;
  if (remap_) remap_(0);
}

std::uint32_t Afio::read_word(std::uint32_t offset) {
  switch (offset) {
    case 0x00:
      return evcr_;
    case 0x04:
      return mapr_ & 0x00FFFFFF;  // SWJ_CFG is write-only
    case 0x08:
    case 0x0C:
    case 0x10:
    case 0x14:
      return ports_.read(static_cast<int>(offset - 8) / 4);
    case 0x1C:
      return mapr2_;
    default:
      return 0;
  }
}

void Afio::write_word(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case 0x00:
      evcr_ = value & 0xFF;
      return;
    case 0x04:
      mapr_ = value & 0x071FFFFF;
      if (remap_) remap_(mapr_);
      return;
    case 0x08:
    case 0x0C:
    case 0x10:
    case 0x14:
      return ports_.write(static_cast<int>(offset - 8) / 4, value);
    case 0x1C:
      mapr2_ = value & 0x7E0;
      return;
    default:
      return;
  }
}

}  // namespace whirl::stm32
