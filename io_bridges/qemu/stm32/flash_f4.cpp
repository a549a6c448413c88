#include "io_bridges/qemu/stm32/flash_f4.hpp"

#include <cmath>

namespace whirl::stm32 {
namespace {

enum Offset : std::uint32_t {
  ACR = 0x00,
  KEYR = 0x04,
  OPTKEYR = 0x08,
  SR = 0x0C,
  CR = 0x10,
  OPTCR = 0x14,
};
// SR
constexpr std::uint32_t EOP = 1u << 0, OPERR = 1u << 1, WRPERR = 1u << 4, PGAERR = 1u << 5,
                        PGPERR = 1u << 6, PGSERR = 1u << 7, BSY = 1u << 16;
constexpr std::uint32_t kErrors = WRPERR | PGAERR | PGPERR | PGSERR;
// CR
constexpr std::uint32_t PG = 1u << 0, SER = 1u << 1, MER = 1u << 2, STRT = 1u << 16,
                        EOPIE = 1u << 24, ERRIE = 1u << 25, LOCK = 1u << 31;
// OPTCR
constexpr std::uint32_t OPTLOCK = 1u << 0, OPTSTRT = 1u << 1;

constexpr std::uint32_t kBase = 0x08000000;
constexpr Nanoseconds kProgram_ns = 16'000, ms = 1'000'000;

struct Sector {
  std::uint32_t offset, bytes;
};
// 4 x 16 KiB, 64 KiB, then 128 KiB each (RM0090 table 5).
Sector sector_at(unsigned n) {
  if (n < 4) return {n * 0x4000, 0x4000};
  if (n == 4) return {0x10000, 0x10000};
  return {(n - 4) * 0x20000, 0x20000};
}
unsigned sector_of(std::uint32_t offset) {
  if (offset < 0x10000) return offset / 0x4000;
  return offset < 0x20000 ? 4 : 4 + offset / 0x20000;
}

// Typical erase times at PSIZE 8, 16, 32 (64 as 32).
Nanoseconds erase_ns(std::uint32_t bytes, unsigned psize) {
  static constexpr int k16K[4] = {400, 300, 250, 250}, k64K[4] = {1200, 700, 550, 550},
                       k128K[4] = {2000, 1300, 1000, 1000};
  return (bytes == 0x4000 ? k16K : bytes == 0x10000 ? k64K : k128K)[psize] * ms;
}

}  // namespace

FlashF4::FlashF4(Chip chip, FlashArray& array, std::uint32_t bytes)
    : WordBlock("FLASH", Narrow::merge),
      chip_(std::move(chip)),
      array_(array),
      bytes_(bytes),
      done_(chip_.events, [this] { done(); }) {
  chip_.clocks.on_change([this] { check_latency(); });
}

void FlashF4::reset() {
  done_.cancel();
  sr_ = 0;
  set_acr(0);
  cr_ = LOCK;
  optcr_ |= OPTLOCK;
  keys_.reset();
  option_keys_.reset();
  update();
}

cycles::FlashTiming FlashF4::timing() const {
  constexpr std::uint32_t kPrften = 1u << 8, kIcen = 1u << 9, kDcen = 1u << 10;
  return {static_cast<int>(acr_ & 7), 16, (acr_ & kPrften) != 0, (acr_ & kIcen) != 0,
          (acr_ & kDcen) != 0};
}

void FlashF4::set_acr(std::uint32_t value) {
  acr_ = value;
  if (timing_changed_) timing_changed_();
}

std::uint32_t FlashF4::read_word(std::uint32_t offset) {
  switch (offset) {
    case ACR:
      return acr_;
    case SR:
      return sr_;
    case CR:
      return cr_;
    case OPTCR:
      return optcr_;
    default:
      return 0;  // keys are write-only
  }
}

void FlashF4::write_word(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case ACR:
      return set_acr(value & 0x1F07);
    case KEYR:
      if ((cr_ & LOCK) != 0 && keys_.open(value)) cr_ &= ~LOCK;
      return;
    case OPTKEYR:
      if ((optcr_ & OPTLOCK) != 0 && option_keys_.open(value)) optcr_ &= ~OPTLOCK;
      return;
    case SR:
      sr_ &= ~(value & (EOP | OPERR | kErrors));
      return update();
    case CR:
      return write_cr(value);
    case OPTCR:
      return write_optcr(value);
    default:
      return;
  }
}

void FlashF4::write_cr(std::uint32_t value) {
  if ((cr_ & LOCK) != 0 || (sr_ & BSY) != 0) return;
  cr_ = value & 0x8301037F;
  if ((value & STRT) != 0) erase();
  update();
}

void FlashF4::write_optcr(std::uint32_t value) {
  if ((optcr_ & OPTLOCK) != 0) return;
  optcr_ = value & 0x0FFFFFED;
  if ((value & OPTSTRT) != 0) busy(16 * ms);
}

bool FlashF4::protected_sector(unsigned sector) const {
  return ((optcr_ >> (16 + sector)) & 1) == 0;  // nWRP
}

void FlashF4::erase() {
  const unsigned psize = (cr_ >> 8) & 3;
  if ((cr_ & MER) != 0) {
    for (unsigned n = 0; n < 12; ++n) {
      if (protected_sector(n)) return fail(WRPERR);
    }
    array_.erase(kBase, bytes_);
    static constexpr int kMass_ms[4] = {16000, 11000, 8000, 8000};
    return busy(kMass_ms[psize] * ms);
  }
  const unsigned n = (cr_ >> 3) & 0xF;
  if ((cr_ & SER) == 0 || n > 11) return fail(PGSERR);
  if (protected_sector(n)) return fail(WRPERR);
  const Sector sector = sector_at(n);
  if (sector.offset + sector.bytes > bytes_) return fail(WRPERR);
  array_.erase(kBase + sector.offset, sector.bytes);
  busy(erase_ns(sector.bytes, psize));
}

void FlashF4::store(std::uint32_t address, unsigned size, std::uint32_t value) {
  const unsigned psize_bytes = 1u << ((cr_ >> 8) & 3);
  if ((cr_ & LOCK) != 0 || (cr_ & PG) == 0) return fail(PGSERR);
  if (address % size != 0) return fail(PGAERR);
  // x64 comes as two words over a 32-bit bus.
  if (size != psize_bytes && !(psize_bytes == 8 && size == 4)) return fail(PGPERR);
  if (protected_sector(sector_of(address - kBase))) return fail(WRPERR);
  array_.program(address, value, size);
  busy(kProgram_ns);
}

void FlashF4::busy(Nanoseconds duration) {
  sr_ |= BSY;
  done_.in(duration);
}

void FlashF4::fail(std::uint32_t error) {
  sr_ |= error;
  cr_ &= ~STRT;
  if ((cr_ & ERRIE) != 0) sr_ |= OPERR;
  update();
}

void FlashF4::done() {
  sr_ &= ~BSY;
  cr_ &= ~STRT;
  optcr_ &= ~OPTSTRT;
  if ((cr_ & EOPIE) != 0) sr_ |= EOP;  // only with its interrupt enabled (RM0090 3.9.4)
  update();
}

void FlashF4::update() {
  constexpr int kFlashIrq = 4;
  chip_.interrupts.set(kFlashIrq, ((cr_ & EOPIE) != 0 && (sr_ & EOP) != 0) ||
                                      ((cr_ & ERRIE) != 0 && (sr_ & OPERR) != 0));
}

// One wait state per 30 MHz (RM0090 table 10, 2.7 to 3.6 V).
void FlashF4::check_latency() {
  const int wanted =
      static_cast<int>(std::ceil(chip_.clocks.nominal_Hz(chip_.clocks.hclk_Hz()) / 30.001e6)) - 1;
  if (latency_reported_ || !chip_.finding || static_cast<int>(acr_ & 7) >= wanted) return;
  latency_reported_ = true;
  chip_.finding({chip_.events.now(), "FLASH", "too few wait states for HCLK"});
}

}  // namespace whirl::stm32
