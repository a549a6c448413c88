#include "io_bridges/qemu/stm32/gpio_f4.hpp"

#include <algorithm>

namespace whirl::stm32 {
namespace {

enum Offset : std::uint32_t {
  MODER = 0x00,
  OTYPER = 0x04,
  OSPEEDR = 0x08,
  PUPDR = 0x0C,
  IDR = 0x10,
  ODR = 0x14,
  BSRR = 0x18,
  LCKR = 0x1C,
  AFRL = 0x20,
  AFRH = 0x24,
};

std::uint32_t field(std::uint32_t reg, int pin, int bits) {
  return (reg >> (pin * bits)) & ((1u << bits) - 1);
}

}  // namespace

GpioF4::GpioF4(Chip chip, PinBank& bank, char port)
    : WordBlock(std::string("GPIO") + port, Narrow::merge),
      chip_(std::move(chip)),
      bank_(bank),
      port_(port) {
  pins_ = bank.make_port(port, [this](int pin, bool level, Nanoseconds now) {
    levels_ = level ? levels_ | (1u << pin) : levels_ & ~(1u << pin);
    if (edge_) edge_(pin, level, now);
  });
  reset();
}

void GpioF4::add_alternate(int pin, int af, Signal& signal) {
  auto& cell = alternates_[static_cast<std::size_t>(pin)][static_cast<std::size_t>(af)];
  cell[cell[0] == nullptr ? 0 : 1] = &signal;
  bank_.connect(*pins_[static_cast<std::size_t>(pin)], signal);
}

void GpioF4::reset() {
  moder_ = port_ == 'A' ? 0xA8000000 : port_ == 'B' ? 0x00000280 : 0;
  ospeedr_ = port_ == 'A' ? 0x0C000000 : port_ == 'B' ? 0x000000C0 : 0;
  pupdr_ = port_ == 'A' ? 0x64000000 : port_ == 'B' ? 0x00000100 : 0;
  otyper_ = odr_ = afr_[0] = afr_[1] = 0;
  lock_.reset();
  for (int pin = 0; pin < 16; ++pin) apply(pin);
}

std::uint32_t GpioF4::read_word(std::uint32_t offset) {
  switch (offset) {
    case MODER:
      return moder_;
    case OTYPER:
      return otyper_;
    case OSPEEDR:
      return ospeedr_;
    case PUPDR:
      return pupdr_;
    case IDR:
      return levels_ & ~analog_;
    case ODR:
      return odr_;
    case LCKR:
      return lock_.read();
    case AFRL:
      return afr_[0];
    case AFRH:
      return afr_[1];
    default:
      return 0;
  }
}

// BSRR is write-only: a narrow write must not repeat what the other half does.
void GpioF4::write(std::uint32_t offset, std::uint32_t value, unsigned size) {
  if (size == 4 || (offset & ~3u) != BSRR) return WordBlock::write(offset, value, size);
  const std::uint32_t mask = size == 1 ? 0xFFu : 0xFFFFu;
  write_word(BSRR, (value & mask) << (8 * (offset & 3)));
}

void GpioF4::write_word(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case MODER:
      return set_configuration(moder_, value, 2, 0);
    case OTYPER:
      return set_configuration(otyper_, value & 0xFFFF, 1, 0);
    case OSPEEDR:
      return set_configuration(ospeedr_, value, 2, 0);
    case PUPDR:
      return set_configuration(pupdr_, value, 2, 0);
    case ODR:
      return set_odr(value & 0xFFFF);
    case BSRR:
      return set_odr((odr_ & ~(value >> 16)) | (value & 0xFFFF));  // set beats reset
    case LCKR:
      return lock_.write(value);
    case AFRL:
      return set_configuration(afr_[0], value, 4, 0);
    case AFRH:
      return set_configuration(afr_[1], value, 4, 8);
    default:
      return;
  }
}

void GpioF4::set_odr(std::uint32_t value) {
  std::uint32_t changed = odr_ ^ value;
  odr_ = value;
  const Nanoseconds now = changed != 0 ? chip_.events.now() : 0;
  for (; changed != 0; changed &= changed - 1) {
    const int pin = __builtin_ctz(changed);
    pins_[static_cast<std::size_t>(pin)]->set_output(((value >> pin) & 1) != 0, now);
  }
}

void GpioF4::set_configuration(std::uint32_t& reg, std::uint32_t value, int bits, int first) {
  std::uint32_t changed_pins = 0;
  for (int pin = first; pin < 16 && (pin - first) * bits < 32; ++pin) {
    const std::uint32_t mask = ((1u << bits) - 1) << ((pin - first) * bits);
    if (((reg ^ value) & mask) == 0) continue;
    if (lock_.holds(pin)) continue;
    reg = (reg & ~mask) | (value & mask);
    changed_pins |= 1u << pin;
  }
  for (; changed_pins != 0; changed_pins &= changed_pins - 1) apply(__builtin_ctz(changed_pins));
}

PinSetting GpioF4::setting(int pin) const {
  PinSetting s;
  s.mode = static_cast<PinMode>(field(moder_, pin, 2));
  s.open_drain = field(otyper_, pin, 1) != 0;
  const std::uint32_t pull = field(pupdr_, pin, 2);
  s.pull = pull == 1 ? Drive::pull_high : pull == 2 ? Drive::pull_low : Drive::none;
  s.output = field(odr_, pin, 1) != 0;
  if (s.mode == PinMode::alternate) {
    const std::uint32_t af = field(afr_[pin / 8], pin % 8, 4);
    const auto& cell = alternates_[static_cast<std::size_t>(pin)][af];
    std::copy(cell.begin(), cell.end(), s.signals.begin());
  }
  return s;
}

void GpioF4::apply(int pin) {
  Pin& p = *pins_[static_cast<std::size_t>(pin)];
  const PinSetting s = setting(pin);
  const std::uint32_t bit = 1u << pin;
  analog_ = s.mode == PinMode::analog ? analog_ | bit : analog_ & ~bit;
  const Nanoseconds now = chip_.events.now();
  for (const Signal* signal : s.signals) {
    if (io::Wire* net = signal != nullptr ? bank_.net(signal) : nullptr) p.join(*net, now);
  }
  p.set(s, now);
}

}  // namespace whirl::stm32
