#include "io_bridges/qemu/stm32/watchdog.hpp"

#include <cmath>

#include "io_bridges/qemu/stm32/register_access.hpp"

namespace whirl::stm32 {

namespace {

enum : std::uint32_t { KR = 0x00, PR = 0x04, RLR = 0x08, SR = 0x0C };
enum : std::uint32_t { WWDG_CR = 0x00, WWDG_CFR = 0x04, WWDG_SR = 0x08 };
constexpr std::uint32_t kReload = 0xAAAA, kUnlock = 0x5555, kStart = 0xCCCC;
constexpr std::uint32_t kWdga = 0x80, kEwi = 0x200;
constexpr int kUpdatePeriods = 5;

}  // namespace

IndependentWatchdog::IndependentWatchdog(const Chip& chip, std::function<void()> bite)
    : chip_(chip), bite_(chip.events, std::move(bite)) {}

void IndependentWatchdog::reset() {
  bite_.cancel();
  running_ = unlocked_ = false;
  prescaler_ = live_prescaler_ = 0;
  reload_ = live_reload_ = count_ = 0xFFF;
  prescaler_ready_ = reload_ready_ = 0;
}

Nanoseconds IndependentWatchdog::lsi_periods_ns(double periods) const {
  return static_cast<Nanoseconds>(std::ceil(periods * 1e9 / chip_.clocks.lsi_Hz()));
}

// A written PR or RLR counts once it has crossed into the LSI domain.
void IndependentWatchdog::settle() {
  const Nanoseconds now = chip_.events.now();
  if (now >= prescaler_ready_) live_prescaler_ = prescaler_;
  if (now >= reload_ready_) live_reload_ = reload_;
}

void IndependentWatchdog::arm() {
  const double divider = 4.0 * (1 << (live_prescaler_ < 6 ? live_prescaler_ : 6));
  bite_.in(lsi_periods_ns(divider * (count_ + 1)));
}

void IndependentWatchdog::key(std::uint32_t value) {
  unlocked_ = value == kUnlock;
  settle();
  if (value == kReload) {
    // A reload takes what was written, also while it is still crossing: the counter is loaded there.
    count_ = reload_;
    live_reload_ = reload_;
    live_prescaler_ = prescaler_;
    if (running_) arm();
  } else if (value == kStart && !running_) {
    running_ = true;
    arm();
  }
}

std::uint32_t IndependentWatchdog::read(std::uint32_t offset, unsigned size) {
  settle();
  const Nanoseconds now = chip_.events.now();
  std::uint32_t word = 0;
  switch (offset & ~3u) {
    case PR:
      word = prescaler_;
      break;
    case RLR:
      word = reload_;
      break;
    case SR:
      word = (now < prescaler_ready_ ? 1 : 0) | (now < reload_ready_ ? 2 : 0);
      break;
    default:
      break;
  }
  return part_of_word(word, offset, size);
}

void IndependentWatchdog::write(std::uint32_t offset, std::uint32_t value, unsigned /*size*/) {
  const Nanoseconds now = chip_.events.now();
  settle();
  switch (offset & ~3u) {
    case KR:
      key(value & 0xFFFF);
      break;
    case PR:
      if (!unlocked_ || now < prescaler_ready_) break;
      prescaler_ = value & 7;
      prescaler_ready_ = now + lsi_periods_ns(kUpdatePeriods);
      break;
    case RLR:
      if (!unlocked_ || now < reload_ready_) break;
      reload_ = value & 0xFFF;
      reload_ready_ = now + lsi_periods_ns(kUpdatePeriods);
      break;
    default:
      break;
  }
}

WindowWatchdog::WindowWatchdog(const Chip& chip, int irq, std::function<void()> bite)
    : chip_(chip),
      early_(chip.events,
             [this] {
               early_flag_ = true;
               irq_.set((cfr_ & kEwi) != 0);
             }),
      bite_event_(chip.events, [this] { bite_(); }),
      bite_(std::move(bite)),
      irq_(chip.interrupts, irq) {
  const auto follow = [this] {
    grid_.set_frequency(chip_.clocks.pclk1_Hz(), chip_.events.now());
    arm();
  };
  chip_.clocks.on_change(follow);
  follow();
}

void WindowWatchdog::reset() {
  early_.cancel();
  bite_event_.cancel();
  active_ = early_flag_ = false;
  cfr_ = written_ = 0x7F;
  written_at_ = grid_.ticks(chip_.events.now());
  irq_.set(false);
}

std::uint32_t WindowWatchdog::count() {
  const std::int64_t passed = (grid_.ticks(chip_.events.now()) - written_at_) / clocks_per_count();
  return static_cast<std::uint32_t>((static_cast<std::int64_t>(written_) - passed) & 0x7F);
}

void WindowWatchdog::arm() {
  early_.cancel();
  bite_event_.cancel();
  if (!active_) return;
  const std::int64_t to_early = (static_cast<std::int64_t>(written_) - 0x40) * clocks_per_count();
  const Nanoseconds early_at = grid_.time(written_at_ + to_early);
  const Nanoseconds bite_at = grid_.time(written_at_ + to_early + clocks_per_count());
  if (early_at == io::kNever) return;
  if (early_at >= chip_.events.now()) early_.at(early_at);
  bite_event_.at(bite_at);
}

void WindowWatchdog::write_control(std::uint32_t value) {
  const bool too_early = active_ && count() > (cfr_ & 0x7F);
  active_ = active_ || (value & kWdga) != 0;
  written_ = value & 0x7F;
  written_at_ = grid_.ticks(chip_.events.now());
  if (!active_) return;
  if (too_early || (written_ & 0x40) == 0) {
    early_.cancel();
    bite_event_.at(chip_.events.now());
  } else {
    arm();
  }
}

std::uint32_t WindowWatchdog::read(std::uint32_t offset, unsigned size) {
  std::uint32_t word = 0;
  switch (offset & ~3u) {
    case WWDG_CR:
      word = count() | (active_ ? kWdga : 0);
      break;
    case WWDG_CFR:
      word = cfr_;
      break;
    case WWDG_SR:
      word = early_flag_ ? 1 : 0;
      break;
    default:
      break;
  }
  return part_of_word(word, offset, size);
}

void WindowWatchdog::write(std::uint32_t offset, std::uint32_t value, unsigned /*size*/) {
  switch (offset & ~3u) {
    case WWDG_CR:
      write_control(value);
      break;
    case WWDG_CFR: {
      const std::uint32_t now = count();
      cfr_ = (value & 0x3FF) | (cfr_ & kEwi);  // EWI is cleared by reset only
      written_ = now;
      written_at_ = grid_.ticks(chip_.events.now());
      arm();
      break;
    }
    case WWDG_SR:
      if ((value & 1) == 0) early_flag_ = false;
      break;
    default:
      break;
  }
  irq_.set(early_flag_ && (cfr_ & kEwi) != 0);
}

}  // namespace whirl::stm32
