#include "io_bridges/qemu/stm32/flash_f1.hpp"

namespace whirl::stm32 {
namespace {

enum Offset : std::uint32_t {
  ACR = 0x00,
  KEYR = 0x04,
  SR = 0x0C,
  CR = 0x10,
  AR = 0x14,
  OBR = 0x1C,
  WRPR = 0x20,
};
constexpr std::uint32_t BSY = 1u << 0, PGERR = 1u << 2, WRPRTERR = 1u << 4, EOP = 1u << 5;
constexpr std::uint32_t PG = 1u << 0, PER = 1u << 1, MER = 1u << 2, STRT = 1u << 6, LOCK = 1u << 7,
                        ERRIE = 1u << 10, EOPIE = 1u << 12;
constexpr Nanoseconds kHalfWord_ns = 52'500, kErase_ns = 30'000'000;

}  // namespace

FlashF1::FlashF1(Chip chip, FlashArray& array, std::uint32_t bytes)
    : WordBlock("FLASH"),
      chip_(std::move(chip)),
      array_(array),
      bytes_(bytes),
      done_(chip_.events, [this] { done(); }) {
  chip_.clocks.on_change([this] { check_latency(); });
}

void FlashF1::reset() {
  done_.cancel();
  set_acr(0x30);
  sr_ = ar_ = 0;
  cr_ = LOCK;
  keys_.reset();
  update();
}

cycles::FlashTiming FlashF1::timing() const {
  constexpr std::uint32_t kPrftbe = 1u << 4;
  return {static_cast<int>(acr_ & 7), 8, (acr_ & kPrftbe) != 0, false, false};
}

void FlashF1::set_acr(std::uint32_t value) {
  acr_ = value;
  if (timing_changed_) timing_changed_();
}

std::uint32_t FlashF1::read_word(std::uint32_t offset) {
  switch (offset) {
    case ACR:
      return acr_;
    case SR:
      return sr_;
    case CR:
      return cr_;
    case OBR:
      return 0x03FFFFFC;
    case WRPR:
      return 0xFFFFFFFF;
    default:
      return 0;
  }
}

void FlashF1::write_word(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case ACR:
      return set_acr((value & 0x1F) | ((value & 0x10) << 1));  // PRFTBS follows PRFTBE
    case KEYR:
      if ((cr_ & LOCK) != 0 && keys_.open(value)) cr_ &= ~LOCK;
      return;
    case SR:
      sr_ &= ~(value & (PGERR | WRPRTERR | EOP));
      return update();
    case CR:
      return write_cr(value);
    case AR:
      if ((sr_ & BSY) == 0) ar_ = value;
      return;
    default:
      return;
  }
}

void FlashF1::write_cr(std::uint32_t value) {
  if ((cr_ & LOCK) != 0 || (sr_ & BSY) != 0) return;
  cr_ = value & 0x16F7;
  if ((cr_ & STRT) != 0) begin();
  update();
}

void FlashF1::begin() {
  if ((cr_ & MER) != 0) {
    array_.erase(kBase, bytes_);
    return busy(kErase_ns);
  }
  const std::uint32_t offset = ar_ - kBase;
  if ((cr_ & PER) == 0 || offset >= bytes_) {
    cr_ &= ~STRT;
    return;
  }
  array_.erase(kBase + offset / kPage * kPage, kPage);
  busy(kErase_ns);
}

bool FlashF1::store(std::uint32_t address, unsigned size, std::uint32_t value) {
  if (size != 2 || (cr_ & LOCK) != 0 || (cr_ & PG) == 0) return false;
  if (array_.read(address, 2) != 0xFFFF && (value & 0xFFFF) != 0) {
    sr_ |= PGERR;
    update();
    return true;
  }
  array_.program(address, value & 0xFFFF, 2);
  busy(kHalfWord_ns);
  return true;
}

void FlashF1::busy(Nanoseconds duration) {
  sr_ |= BSY;
  done_.in(duration);
}

void FlashF1::done() {
  sr_ = (sr_ & ~BSY) | EOP;
  cr_ &= ~STRT;
  update();
}

void FlashF1::update() {
  constexpr int kFlashIrq = 4;
  chip_.interrupts.set(kFlashIrq, ((cr_ & EOPIE) != 0 && (sr_ & EOP) != 0) ||
                                      ((cr_ & ERRIE) != 0 && (sr_ & (PGERR | WRPRTERR)) != 0));
}

// 0 up to 24 MHz, 1 up to 48, 2 above (RM0008 3.3.3).
void FlashF1::check_latency() {
  const double hclk_Hz = chip_.clocks.nominal_Hz(chip_.clocks.hclk_Hz());
  const std::uint32_t wanted = hclk_Hz > 48.001e6 ? 2 : hclk_Hz > 24.001e6 ? 1 : 0;
  if (latency_reported_ || !chip_.finding || (acr_ & 7) >= wanted) return;
  latency_reported_ = true;
  chip_.finding({chip_.events.now(), "FLASH", "too few wait states for HCLK"});
}

}  // namespace whirl::stm32
