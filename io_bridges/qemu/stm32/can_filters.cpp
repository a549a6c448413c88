#include "io_bridges/qemu/stm32/can_filters.hpp"

#include "io_bridges/qemu/stm32/register_access.hpp"

namespace whirl::stm32 {

namespace {

enum : std::uint32_t {
  FMR = 0x200,
  FM1R = 0x204,
  FS1R = 0x20C,
  FFA1R = 0x214,
  FA1R = 0x21C,
  BANKS = 0x240
};

// The frame's head as a 32-bit filter sees it: STID EXID IDE RTR 0.
std::uint32_t wide_head(const io::CanFrame& frame) {
  const std::uint32_t id = frame.extended ? frame.id << 3 : frame.id << 21;
  return id | (frame.extended ? 4u : 0) | (frame.remote ? 2u : 0);
}

// As a 16-bit filter sees it: STID[10:0] RTR IDE EXID[17:15].
std::uint32_t narrow_head(const io::CanFrame& frame) {
  const std::uint32_t flags = (frame.remote ? 16u : 0) | (frame.extended ? 8u : 0);
  if (!frame.extended) return (frame.id & 0x7FF) << 5 | flags;
  return (frame.id >> 18) << 5 | flags | (frame.id >> 15 & 7);
}

}  // namespace

void CanFilters::reset() {
  fmr_ = 0x2A1C0E01;
  mode_ = scale_ = fifo_ = active_ = 0;
  bank_ = {};
}

std::uint32_t CanFilters::read(std::uint32_t offset) const {
  switch (offset) {
    case FMR:
      return fmr_;
    case FM1R:
      return mode_;
    case FS1R:
      return scale_;
    case FFA1R:
      return fifo_;
    case FA1R:
      return active_;
    default:
      break;
  }
  const std::uint32_t n = (offset - BANKS) / 4;
  return offset >= BANKS && n < 2u * static_cast<unsigned>(banks_) ? bank_[n / 2][n % 2] : 0;
}

// Mode, scale and assignment only in filter initialisation; a bank also while it is inactive.
void CanFilters::write(std::uint32_t offset, std::uint32_t value) {
  const bool init = bit(fmr_, 0);
  const std::uint32_t all = banks_ == 28 ? 0x0FFFFFFF : 0x3FFF;
  switch (offset) {
    case FMR:
      fmr_ = 0x2A1C0000 | (banks_ == 28 ? value & 0x3F01 : 0xE00 | (value & 1));
      return;
    case FM1R:
      if (init) mode_ = value & all;
      return;
    case FS1R:
      if (init) scale_ = value & all;
      return;
    case FFA1R:
      if (init) fifo_ = value & all;
      return;
    case FA1R:
      active_ = value & all;
      return;
    default:
      break;
  }
  const std::uint32_t n = (offset - BANKS) / 4;
  if (offset < BANKS || n >= 2u * static_cast<unsigned>(banks_)) return;
  if (init || !bit(active_, n / 2)) bank_[n / 2][n % 2] = value;
}

int CanFilters::first_of_second() const {
  return banks_ == 28 ? static_cast<int>(field(fmr_, 8, 6)) : banks_;
}

int CanFilters::filters_in(int bank) const {
  const auto n = static_cast<unsigned>(bank);
  return (bit(scale_, n) ? 1 : 2) * (bit(mode_, n) ? 2 : 1);
}

bool CanFilters::one_matches(int bank, int which, std::uint32_t wide, std::uint32_t narrow) const {
  const auto n = static_cast<unsigned>(bank);
  const auto& reg = bank_[n];
  const bool list = bit(mode_, n);
  if (bit(scale_, n)) {
    if (list) return ((reg[static_cast<std::size_t>(which)] ^ wide) & ~1u) == 0;
    return ((reg[0] ^ wide) & reg[1] & ~1u) == 0;
  }
  if (list) {
    const std::uint32_t word = reg[static_cast<std::size_t>(which / 2)];
    return (which % 2 == 0 ? word & 0xFFFF : word >> 16) == narrow;
  }
  const std::uint32_t word = reg[static_cast<std::size_t>(which)];
  return ((word ^ narrow) & (word >> 16) & 0xFFFF) == 0;
}

CanFilters::Match CanFilters::match(const io::CanFrame& frame, bool second_can) const {
  Match best;
  int best_rank = -1;
  if (bit(fmr_, 0)) return best;  // reception is off while filters are initialised
  const std::uint32_t wide = wide_head(frame), narrow = narrow_head(frame);
  std::uint32_t number[2] = {0, 0};
  const int first = second_can ? first_of_second() : 0;
  const int end = second_can ? banks_ : first_of_second();
  for (int bank = first; bank < end; ++bank) {
    const auto n = static_cast<unsigned>(bank);
    const int fifo = bit(fifo_, n) ? 1 : 0;
    const int rank = (bit(scale_, n) ? 2 : 0) + (bit(mode_, n) ? 1 : 0);
    for (int which = 0; which < filters_in(bank); ++which, ++number[fifo]) {
      if (!bit(active_, n) || rank <= best_rank || !one_matches(bank, which, wide, narrow))
        continue;
      best = {true, fifo, number[fifo]};
      best_rank = rank;
    }
  }
  return best;
}

}  // namespace whirl::stm32
