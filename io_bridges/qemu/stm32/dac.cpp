#include "io_bridges/qemu/stm32/dac.hpp"

#include <bit>
#include <utility>

#include "io_bridges/qemu/stm32/register_access.hpp"

namespace whirl::stm32 {

namespace {

enum : std::uint32_t {
  CR = 0x00,
  SWTRIGR = 0x04,
  DHR12R1 = 0x08,
  DHR12L1 = 0x0C,
  DHR8R1 = 0x10,
  DHR12R2 = 0x14,
  DHR12L2 = 0x18,
  DHR8R2 = 0x1C,
  DHR12RD = 0x20,
  DHR12LD = 0x24,
  DHR8RD = 0x28,
  DOR1 = 0x2C,
  DOR2 = 0x30,
  SR = 0x34,
};
constexpr std::uint32_t kEnable = 1, kTriggered = 4, kDma = 1u << 12, kUnderrunIe = 1u << 13;
constexpr std::uint32_t kUnderrun = 1u << 13;
constexpr unsigned kSoftware = 7;
constexpr double kVdda_V = 3.3;

}  // namespace

Dac::Dac(const Chip& chip, int irq) : irq_(chip.interrupts, irq) {
  for (Channel& c : channel_) {
    c.request.on_served([&c] { c.request.set(false); });
  }
}

void Dac::reset() {
  cr_ = sr_ = 0;
  for (Channel& c : channel_) {
    c.holding = c.output = c.triangle = 0;
    c.noise = 0xAAA;
    c.triangle_falls = false;
    c.request.set(false);
  }
  select_triggers();
  update_interrupt();
  tell();
}

void Dac::on_change(int channel, std::function<void(double volts)> told) {
  channel_[static_cast<std::size_t>(channel - 1)].told = std::move(told);
}

void Dac::tell() {
  for (int channel = 1; channel <= 2; ++channel) {
    Channel& c = channel_[static_cast<std::size_t>(channel - 1)];
    const double now_V = volts(channel);
    if (!c.told || std::bit_cast<std::uint64_t>(now_V) == std::bit_cast<std::uint64_t>(c.told_V)) {
      continue;
    }
    c.told_V = now_V;
    c.told(now_V);
  }
}

double Dac::volts(int channel) const {
  const auto ch = static_cast<std::size_t>(channel - 1);
  return (cr_ & (kEnable << (16 * ch))) != 0 ? channel_[ch].output * kVdda_V / 4096.0 : 0.0;
}

void Dac::connect_trigger(unsigned selection, TriggerLine& line) {
  Tap& tap = taps_[selection];
  tap.line = &line;
  for (int ch = 0; ch < 2; ++ch) {
    tap.handle[static_cast<std::size_t>(ch)] = line.add_sink([this, ch](bool level, Nanoseconds) {
      if (level) trigger(ch);
    });
  }
}

void Dac::select_triggers() {
  for (int ch = 0; ch < 2; ++ch) {
    const std::uint32_t control_bits = control(ch);
    const bool on = (control_bits & kEnable) != 0 && (control_bits & kTriggered) != 0;
    for (unsigned i = 0; i < taps_.size(); ++i) {
      const Tap& tap = taps_[i];
      if (tap.line == nullptr) continue;
      tap.line->listen(tap.handle[static_cast<std::size_t>(ch)],
                       on && field(control_bits, 3, 3) == i);
    }
  }
}

void Dac::update_interrupt() {
  irq_.set((sr_ & cr_ & (kUnderrunIe | kUnderrunIe << 16)) != 0);
}

// Without trigger a held value goes out at once.
void Dac::hold(int ch, std::uint32_t value12) {
  Channel& c = channel_[static_cast<std::size_t>(ch)];
  c.holding = value12 & 0xFFF;
  if ((control(ch) & kTriggered) == 0) c.output = c.holding;
}

std::uint32_t Dac::step_triangle(Channel& c, std::uint32_t top) {
  if (c.triangle >= top) c.triangle_falls = true;
  if (c.triangle == 0) c.triangle_falls = false;
  c.triangle += c.triangle_falls ? -1u : 1u;
  return c.triangle;
}

void Dac::wave(int ch) {
  Channel& c = channel_[static_cast<std::size_t>(ch)];
  const unsigned shape = field(control(ch), 6, 2);
  const unsigned wide = field(control(ch), 8, 4);
  const std::uint32_t mask = (2u << (wide < 11 ? wide : 11)) - 1;
  c.output = c.holding;
  if (shape == 1) {  // LFSR over taps 0, 1, 4, 6
    const std::uint32_t next = (c.noise ^ c.noise >> 1 ^ c.noise >> 4 ^ c.noise >> 6) & 1;
    c.noise = c.noise == 0 ? 0x800 : c.noise >> 1 | next << 11;
    c.output = (c.holding + (c.noise & mask)) & 0xFFF;
  } else if (shape >= 2) {
    c.output = (c.holding + step_triangle(c, mask)) & 0xFFF;
  }
}

void Dac::trigger(int ch) {
  wave(ch);
  tell();
  if ((control(ch) & kDma) == 0) return;
  Channel& c = channel_[static_cast<std::size_t>(ch)];
  if (c.request.level()) {
    sr_ |= kUnderrun << (16 * ch);
    update_interrupt();
  } else {
    c.request.set(true);
  }
}

std::uint32_t Dac::read(std::uint32_t offset, unsigned size) {
  const Channel &a = channel_[0], &b = channel_[1];
  std::uint32_t word = 0;
  switch (offset & ~3u) {
    case CR:
      word = cr_;
      break;
    case DHR12R1:
      word = a.holding;
      break;
    case DHR12L1:
      word = a.holding << 4;
      break;
    case DHR8R1:
      word = a.holding >> 4;
      break;
    case DHR12R2:
      word = b.holding;
      break;
    case DHR12L2:
      word = b.holding << 4;
      break;
    case DHR8R2:
      word = b.holding >> 4;
      break;
    case DHR12RD:
      word = b.holding << 16 | a.holding;
      break;
    case DHR12LD:
      word = b.holding << 20 | a.holding << 4;
      break;
    case DHR8RD:
      word = b.holding >> 4 << 8 | a.holding >> 4;
      break;
    case DOR1:
      word = a.output;
      break;
    case DOR2:
      word = b.output;
      break;
    case SR:
      word = sr_;
      break;
    default:
      break;
  }
  return part_of_word(word, offset, size);
}

void Dac::write(std::uint32_t offset, std::uint32_t value, unsigned size) {
  value = on_all_lanes(value, size);
  switch (offset & ~3u) {
    case CR:
      cr_ = value & 0x3FFF3FFF;
      for (int ch = 0; ch < 2; ++ch) {
        if ((control(ch) & kDma) == 0) channel_[static_cast<std::size_t>(ch)].request.set(false);
      }
      select_triggers();
      break;
    case SWTRIGR:
      for (int ch = 0; ch < 2; ++ch) {
        const bool software = field(control(ch), 3, 3) == kSoftware;
        const bool on = (control(ch) & (kEnable | kTriggered)) == (kEnable | kTriggered);
        if (bit(value, static_cast<unsigned>(ch)) && software && on) trigger(ch);
      }
      break;
    case DHR12R1:
      hold(0, value);
      break;
    case DHR12L1:
      hold(0, value >> 4);
      break;
    case DHR8R1:
      hold(0, (value & 0xFF) << 4);
      break;
    case DHR12R2:
      hold(1, value);
      break;
    case DHR12L2:
      hold(1, value >> 4);
      break;
    case DHR8R2:
      hold(1, (value & 0xFF) << 4);
      break;
    case DHR12RD:
      hold(0, value), hold(1, value >> 16);
      break;
    case DHR12LD:
      hold(0, value >> 4), hold(1, value >> 20);
      break;
    case DHR8RD:
      hold(0, (value & 0xFF) << 4), hold(1, (value >> 8 & 0xFF) << 4);
      break;
    case SR:
      sr_ &= ~(value & (kUnderrun | kUnderrun << 16));
      break;
    default:
      break;
  }
  update_interrupt();
  tell();
}

}  // namespace whirl::stm32
