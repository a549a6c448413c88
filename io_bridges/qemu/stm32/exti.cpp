#include "io_bridges/qemu/stm32/exti.hpp"

namespace whirl::stm32 {
namespace {

enum Offset : std::uint32_t {
  IMR = 0x00,
  EMR = 0x04,
  RTSR = 0x08,
  FTSR = 0x0C,
  SWIER = 0x10,
  PR = 0x14,
};
constexpr std::uint32_t kMask = 0x7FFFFF;

}  // namespace

Exti::Exti(Chip chip, const std::array<int, kLines>& irq_of_line)
    : WordBlock("EXTI"), chip_(std::move(chip)), irq_of_line_(irq_of_line) {
  port_.fill('A');
}

void Exti::reset() {
  imr_ = emr_ = rtsr_ = ftsr_ = swier_ = pr_ = 0;
  update_irqs(kMask);
}

void Exti::pin_edge(char port, int pin, bool level) {
  if (port_[static_cast<std::size_t>(pin)] == port) set_line(pin, level);
}

void Exti::select_port(int line, char port, bool level) {
  port_[static_cast<std::size_t>(line)] = port;
  set_line(line, level);
}

void Exti::set_line(int line, bool level) {
  const std::uint32_t bit = 1u << line;
  if (((level_ & bit) != 0) == level) return;
  level_ ^= bit;
  if (((level ? rtsr_ : ftsr_) & bit) == 0) return;
  if ((emr_ & bit) != 0 && event_) event_(line);
  pr_ |= bit;
  update_irqs(bit);
}

std::uint32_t Exti::read_word(std::uint32_t offset) {
  switch (offset) {
    case IMR:
      return imr_;
    case EMR:
      return emr_;
    case RTSR:
      return rtsr_;
    case FTSR:
      return ftsr_;
    case SWIER:
      return swier_;
    case PR:
      return pr_;
    default:
      return 0;
  }
}

void Exti::write_word(std::uint32_t offset, std::uint32_t value) {
  value &= kMask;
  switch (offset) {
    case IMR: {
      const std::uint32_t changed = imr_ ^ value;
      imr_ = value;
      return update_irqs(changed);
    }
    case EMR:
      emr_ = value;
      return;
    case RTSR:
      rtsr_ = value;
      return;
    case FTSR:
      ftsr_ = value;
      return;
    case SWIER: {
      const std::uint32_t rising = value & ~swier_;
      swier_ |= value;
      pr_ |= rising & imr_;
      if (event_ && (rising & emr_) != 0) event_(__builtin_ctz(rising & emr_));
      return update_irqs(rising);
    }
    case PR:
      pr_ &= ~value;
      swier_ &= ~value;
      return update_irqs(value);
    default:
      return;
  }
}

// A shared interrupt is up as long as any of its lines is pending and unmasked.
void Exti::update_irqs(std::uint32_t lines) {
  int done = -1;
  for (; lines != 0; lines &= lines - 1) {
    const int irq = irq_of_line_[static_cast<std::size_t>(__builtin_ctz(lines))];
    if (irq == done) continue;
    done = irq;
    bool up = false;
    for (std::uint32_t p = pr_ & imr_; p != 0; p &= p - 1) {
      up = up || irq_of_line_[static_cast<std::size_t>(__builtin_ctz(p))] == irq;
    }
    chip_.interrupts.set(irq, up);
  }
}

void ExtiPorts::reset() {
  for (int i = 0; i < 4; ++i) write(i, 0);
}

void ExtiPorts::write(int index, std::uint32_t value) {
  value &= 0xFFFF;
  exticr_[static_cast<std::size_t>(index)] = value;
  for (int i = 0; i < 4; ++i) {
    const int line = 4 * index + i;
    const char port = static_cast<char>('A' + ((value >> (4 * i)) & 0xF));
    exti_.select_port(line, port, level_(port, line));
  }
}

void Syscfg::reset() {
  ports_.reset();
  memrmp_ = pmc_ = cmpcr_ = 0;
  if (remap_) remap_(0);
}

std::uint32_t Syscfg::read_word(std::uint32_t offset) {
  switch (offset) {
    case 0x00:
      return memrmp_;
    case 0x04:
      return pmc_;
    case 0x08:
    case 0x0C:
    case 0x10:
    case 0x14:
      return ports_.read(static_cast<int>(offset - 8) / 4);
    case 0x20:
      return cmpcr_ | ((cmpcr_ & 1) << 8);  // the compensation cell is ready at once
    default:
      return 0;
  }
}

void Syscfg::write_word(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case 0x00:
      memrmp_ = value & 3;
      if (remap_) remap_(memrmp_);
      return;
    case 0x04:
      pmc_ = value & 0x00800000;
      return;
    case 0x08:
    case 0x0C:
    case 0x10:
    case 0x14:
      return ports_.write(static_cast<int>(offset - 8) / 4, value);
    case 0x20:
      cmpcr_ = value & 1;
      return;
    default:
      return;
  }
}

}  // namespace whirl::stm32
