#include "io_bridges/qemu/stm32/rng.hpp"

#include "io_bridges/qemu/stm32/register_access.hpp"

namespace whirl::stm32 {

namespace {

enum : std::uint32_t { CR = 0x00, SR = 0x04, DR = 0x08 };
constexpr std::uint32_t kEnable = 4, kInterrupt = 8, kReady = 1;
constexpr Nanoseconds kPeriod_ns = 834;  // 40 / 48 MHz, rounded up

}  // namespace

Rng::Rng(const Chip& chip, int irq, std::uint64_t seed)
    : stream_(seed, "stm32.rng"),
      ready_event_(chip.events,
                   [this] {
                     word_ = stream_.bits();
                     ready_ = true;
                     update();
                   }),
      irq_(chip.interrupts, irq) {}

void Rng::reset() {
  ready_event_.cancel();
  cr_ = word_ = 0;
  ready_ = false;
  update();
}

void Rng::update() {
  irq_.set(ready_ && (cr_ & kInterrupt) != 0);
}

std::uint32_t Rng::next() {
  if (!ready_) return 0;
  ready_ = false;
  update();
  ready_event_.in(kPeriod_ns);
  return word_;
}

std::uint32_t Rng::read(std::uint32_t offset, unsigned size) {
  std::uint32_t word = 0;
  switch (offset & ~3u) {
    case CR:
      word = cr_;
      break;
    case SR:
      word = ready_ ? kReady : 0;
      break;
    case DR:
      word = next();
      break;
    default:
      break;
  }
  return part_of_word(word, offset, size);
}

void Rng::write(std::uint32_t offset, std::uint32_t value, unsigned /*size*/) {
  if ((offset & ~3u) != CR) return;
  cr_ = value & (kEnable | kInterrupt);
  if ((cr_ & kEnable) == 0) {
    ready_event_.cancel();
    ready_ = false;
  } else if (!ready_ && !ready_event_.pending()) {
    ready_event_.in(kPeriod_ns);
  }
  update();
}

}  // namespace whirl::stm32
